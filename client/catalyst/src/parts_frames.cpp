#include "parts_frames.hpp"

#include <algorithm>
#include <array>

#include "c_options.hpp"
#include "failure.hpp"
#include "run_name.hpp"
#include "server_away.hpp"

namespace meniscus::catalyst {

PartsFrames::PartsFrames(const RunOptions& options, const Ranks& ranks, Notices& notices)
    : ranks_(ranks), notices_(notices), options_(options.session), server_(options.server) {
    options_.insert(options.connection.begin(), options.connection.end());
    id_ = draw_name(options, ranks).session_id;
    options_.insert_or_assign("session", id_);
    options_.insert_or_assign("server", server_);
    if (const meniscus_result result = open(); result < 0 && !is_away(result))
        throw Failure(result, meniscus_error_message());
    // The simulation goes on now, and is held up by no server that does not answer.
    options_.erase("wait");
    options_.try_emplace("timeout", "1");
}

meniscus_result PartsFrames::open() {
    const meniscus_result result = ranks_.open_parts(*c_options(options_), &parts_);
    if (result == MENISCUS_OK) {
        said_.clear();
        if (ranks_.rank() == 0)
            notices_.say("surfaces of the ranks go to session " + id_ + " on " + server_ +
                         (left_out_ == 0 ? "" : "; " + std::to_string(left_out_) + " frames were left out"));
        return result;
    }
    say_away("the server is there");
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
    return result;
}

void PartsFrames::say_away(const std::string& until) {
    const std::string why = meniscus_error_message();
    if (ranks_.rank() != 0 || why == said_) return;
    said_ = why;
    notices_.say(why + "; frames are left out until " + until);
}

void PartsFrames::push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) {
    const bool is_time = ranks_.rank() != 0 || Clock::now() >= next_attempt_;
    const auto [all_have_frames, all_try] = ranks_.least({particles != nullptr ? 1 : 0, is_time ? 1 : 0});
    if (parts_ == nullptr && all_try != 0) open();
    if (parts_ == nullptr || all_have_frames == 0) {
        ++left_out_;
        return;
    }
    const meniscus_result result = meniscus_parts_push(parts_, particles, index, simulation_time);
    if (result == MENISCUS_OK) {
        ++sent_;
        return;
    }
    ++left_out_;
    if (result == MENISCUS_WOULD_WAIT) return;
    if (!is_away(result)) throw Failure(result, meniscus_error_message());
    say_away("session " + id_ + " is open again");
}

void PartsFrames::finish() {
    if (parts_ != nullptr && meniscus_parts_free(parts_) < 0 && ranks_.rank() == 0)
        notices_.say(meniscus_error_message());
    parts_ = nullptr;
    if (left_out_ != 0 && ranks_.rank() == 0)
        notices_.say(std::to_string(left_out_) + " frames were left out, " + std::to_string(sent_) + " were taken");
}

}  // namespace meniscus::catalyst
