#include "frames.hpp"

namespace meniscus::catalyst {

Frames::Frames(const RunOptions& options, const Ranks& ranks, Notices& notices)
    : options_(options), ranks_(ranks), notices_(notices), name_(draw_name(options, ranks)) {}

void Frames::count_left_out(bool is_away) {
    ++left_out_;
    if (is_away) ++left_out_meanwhile_;
}

void Frames::say_open(const std::string& what) {
    said_.clear();
    if (ranks_.rank() == 0)
        notices_.say(what + " go to " +
                     (output().empty() ? "session " + session_id() + " on " + options_.server : output()) +
                     (left_out_meanwhile_ == 0 ? "" : "; " + std::to_string(left_out_meanwhile_) + " were left out"));
    left_out_meanwhile_ = 0;
}

void Frames::say_away(const std::string& why, const std::string& consequence) {
    if (why.empty() || why == said_) return;
    said_ = why;
    notices_.say(why + "; " + consequence);
}

void Frames::say_counts() const {
    if (left_out_ != 0 && ranks_.rank() == 0)
        notices_.say(std::to_string(left_out_) + " frames were left out, " + std::to_string(sent_) + " were sent");
}

}  // namespace meniscus::catalyst
