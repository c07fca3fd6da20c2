#include "parts_frames.hpp"

#include <algorithm>
#include <array>

#include "c_options.hpp"
#include "run_name.hpp"
#include "server_away.hpp"

namespace meniscus::catalyst {

PartsFrames::PartsFrames(const RunOptions& options, const Ranks& ranks, Notices& notices)
    : ranks_(ranks), notices_(notices), options_(options.session), server_(options.server) {
    options_.insert(options.connection.begin(), options.connection.end());
    id_ = draw_name(options, ranks).session_id;
    options_.insert_or_assign("session", id_);
    options_.insert_or_assign("server", server_);
    if (const meniscus_result result = open(); result < 0 && !is_away(result)) throw failure(result);
    if (parts_ == nullptr) say_left_out(" until the server is there");
    // The simulation goes on now, and is held up by no server that does not answer.
    options_.erase("wait");
    options_.try_emplace("timeout", "1");
}

meniscus_result PartsFrames::open() {
    const meniscus_result result = ranks_.open_parts(*c_options(options_), &parts_);
    if (result == MENISCUS_OK) {
        say_there();
        return result;
    }
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
    return result;
}

Failure PartsFrames::failure(meniscus_result result) const {
    // It is the same on all ranks.
    return {result, ranks_.rank() == 0 ? meniscus_error_message() : ""};
}

void PartsFrames::say_there() {
    taken_since_ = 0;
    said_.clear();
    if (ranks_.rank() == 0)
        notices_.say("surfaces of the ranks go to session " + id_ + " on " + server_ +
                     (left_out_meanwhile_ == 0 ? "" : "; " + std::to_string(left_out_meanwhile_) + " were left out"));
    left_out_meanwhile_ = 0;
}

void PartsFrames::say_left_out(const std::string& until) {
    taken_since_ = 0;
    const std::string why = meniscus_error_message();
    if (why == said_) return;
    said_ = why;
    if (ranks_.rank() == 0) notices_.say(why + "; frames are left out" + until);
}

void PartsFrames::leave_out(bool is_away) {
    ++left_out_;
    if (is_away) ++left_out_meanwhile_;
}

void PartsFrames::push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) {
    const bool is_time = ranks_.rank() != 0 || Clock::now() >= next_attempt_;
    const auto [all_have_frames, all_try] = ranks_.least({particles != nullptr ? 1 : 0, is_time ? 1 : 0});
    // Also what a server refuses is tried again: it has been away, and may be another one.
    if (parts_ == nullptr && all_try != 0 && open() != MENISCUS_OK) say_left_out("");
    if (parts_ == nullptr || all_have_frames == 0) return leave_out(parts_ == nullptr);
    const meniscus_result result = meniscus_parts_push(parts_, particles, index, simulation_time);
    if (result == MENISCUS_OK) {
        ++sent_;
        // A frame is published after the next push, and what then fails is told by the one after that.
        if (!said_.empty() && ++taken_since_ == 3) say_there();
        return;
    }
    leave_out(!said_.empty() || is_away(result));
    if (result == MENISCUS_WOULD_WAIT) return;
    if (!is_away(result)) throw failure(result);
    say_left_out(" until session " + id_ + " is open again");
}

void PartsFrames::finish() {
    if (parts_ != nullptr && meniscus_parts_free(parts_) < 0 && ranks_.rank() == 0)
        notices_.say(meniscus_error_message());
    parts_ = nullptr;
    if (left_out_ != 0 && ranks_.rank() == 0)
        notices_.say(std::to_string(left_out_) + " frames were left out, " + std::to_string(sent_) + " were taken");
}

}  // namespace meniscus::catalyst
