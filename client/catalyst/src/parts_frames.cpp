#include "parts_frames.hpp"

#include <algorithm>
#include <array>

#include "c_options.hpp"
#include "server_away.hpp"

namespace meniscus::catalyst {

PartsFrames::PartsFrames(const RunOptions& options, const Ranks& ranks, Notices& notices)
    : Frames(options, ranks, notices), parts_options_(options.session) {
    parts_options_.insert(options.connection.begin(), options.connection.end());
    if (options.output.empty()) {
        parts_options_.insert_or_assign("session", session_id());
        parts_options_.insert_or_assign("server", options.server);
    } else {
        parts_options_.insert_or_assign("output", options.output);
    }
    if (const meniscus_result result = open(); result < 0 && !is_away(result)) throw failure(result);
    if (parts_ == nullptr) lose("frames are left out until the server is there");
    // The simulation goes on now, and is held up by no server that does not answer.
    parts_options_.erase("wait");
    parts_options_.try_emplace("timeout", "1");
}

meniscus_result PartsFrames::open() {
    const meniscus_result result = ranks_.open_parts(c_options(parts_options_).get(), &parts_);
    if (result == MENISCUS_OK) {
        say_surfaces_go();
        return result;
    }
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
    return result;
}

Failure PartsFrames::failure(meniscus_result result) const {
    return {result, ranks_.rank() == 0 ? meniscus_error_message() : ""};
}

void PartsFrames::lose(const std::string& consequence) {
    taken_since_ = 0;
    if (ranks_.rank() == 0) say_away(meniscus_error_message(), consequence);
}

void PartsFrames::say_surfaces_go() {
    say_open("surfaces of the ranks");
}

void PartsFrames::push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) {
    const bool is_time = ranks_.rank() != 0 || Clock::now() >= next_attempt_;
    const auto [all_have_frames, all_try] = ranks_.least({particles != nullptr ? 1 : 0, is_time ? 1 : 0});
    // Also what a server refuses is tried again: it has been away, and may be another one.
    if (parts_ == nullptr && all_try != 0 && open() != MENISCUS_OK) lose("frames are left out");
    if (parts_ == nullptr || all_have_frames == 0) return count_left_out(parts_ == nullptr);
    const meniscus_result result = meniscus_parts_push(parts_, particles, index, simulation_time);
    if (result == MENISCUS_OK) {
        count_sent();
        // A frame is published after two more pushes, and what then fails is told by the one after them.
        if (is_said_away() && ++taken_since_ == 4) say_surfaces_go();
        return;
    }
    count_left_out(is_said_away() || is_away(result));
    if (result == MENISCUS_WOULD_WAIT) return;
    if (!is_away(result)) throw failure(result);
    lose("frames are left out until session " + session_id() + " is open again");
}

void PartsFrames::finish() {
    if (parts_ != nullptr && meniscus_parts_free(parts_) < 0 && ranks_.rank() == 0)
        notices_.say(meniscus_error_message());
    parts_ = nullptr;
    say_counts();
}

}  // namespace meniscus::catalyst
