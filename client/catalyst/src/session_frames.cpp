#include "session_frames.hpp"

#include <utility>

#include "failure.hpp"
#include "server_away.hpp"

namespace meniscus::catalyst {
namespace {

/// Seconds without an answer, at the end: of a server that has stopped.
constexpr double last_answers = 30.0;

}  // namespace

SessionFrames::SessionFrames(const RunOptions& options, const Ranks& ranks, Notices& notices)
    : Frames(options, ranks, notices), run_(first_run()) {
    open(false);
    const bool refused = opening_->first_attempt() == SessionOpening::State::refused;
    if (ranks.least({refused ? 0 : 1, 0})[0] == 0)
        throw refused ? Failure(opening_->result(), opening_->message())
                      : Failure(MENISCUS_FAILED_PRECONDITION, "another rank's session was refused, which says why");
    if (look() == State::awaited) say_awaited();
}

void SessionFrames::open(bool again) {
    text_options::Options session = options_.session;
    session.insert_or_assign("session", session_id());
    if (ranks_.size() > 1) {
        session.insert_or_assign("parts", std::to_string(ranks_.size()));
        session.insert_or_assign("part", std::to_string(ranks_.rank()));
        session.insert_or_assign("run", std::to_string(run_));
    }
    opening_.emplace(options_.server, options_.connection, std::move(session), again);
}

void SessionFrames::lose(const std::string& why) {
    // Ours or not, it stays for those that watch it: an ephemeral one ends unless its stream comes again.
    meniscus_session_leave(session_.get());
    session_.reset();
    say_away(why, "frames are left out until session " + session_id() + " is open again");
}

void SessionFrames::say_awaited() {
    const bool refused = opening_->state() == SessionOpening::State::refused;
    say_away(opening_->message(), refused ? "no frames are sent" : "frames are left out until the server is there");
}

void SessionFrames::take_answers() {
    if (session_ == nullptr) return;
    meniscus_frame* frame = nullptr;
    meniscus_result result = MENISCUS_OK;
    while ((result = meniscus_session_next(session_.get(), 0.0, &frame)) == MENISCUS_OK) meniscus_frame_destroy(frame);
    if (result < 0) lose(meniscus_error_message());
    if (result == MENISCUS_ENDED) lose("the session has been ended");
}

SessionFrames::State SessionFrames::look() {
    take_answers();
    if (opening_ && opening_->state() == SessionOpening::State::open) {
        session_ = opening_->take();
        opening_.reset();
        say_open("frames");
    }
    return session_ != nullptr ? State::open : opening_ ? State::awaited : State::lost;
}

void SessionFrames::push(const meniscus_particles* particles, std::uint64_t index, double simulation_time) {
    const State here = look();
    const auto [all_have_frames, least] = ranks_.least({particles != nullptr ? 1 : 0, static_cast<int>(here)});
    const auto state = static_cast<State>(least);
    if (state == State::lost) {
        if (session_ != nullptr) lose("another rank has lost the session");
        ++run_;
        open(true);
    } else if (here == State::awaited) {
        say_awaited();
    }
    if (state != State::open || all_have_frames == 0) return count_left_out(state != State::open);
    const meniscus_result result = meniscus_session_push(session_.get(), particles, index, simulation_time);
    if (result == MENISCUS_OK) return count_sent();
    count_left_out(is_away(result));
    if (!is_away(result)) throw Failure(result, meniscus_error_message());
    lose(meniscus_error_message());
}

void SessionFrames::finish() {
    const auto state = static_cast<State>(ranks_.least({1, static_cast<int>(look())})[1]);
    if (state == State::open) {
        meniscus_frame* frame = nullptr;
        meniscus_result result = meniscus_session_finish(session_.get());
        while (result == MENISCUS_OK &&
               (result = meniscus_session_next(session_.get(), last_answers, &frame)) == MENISCUS_OK)
            meniscus_frame_destroy(frame);
        if (result < 0) notices_.say(meniscus_error_message());
        if (result == MENISCUS_NOTHING_YET) notices_.say("the server does not answer the last frames; they are left");
    }
    ranks_.wait_for_all();  // one of them has made the session, and ends it
    session_.reset();
    opening_.reset();
    say_counts();
}

}  // namespace meniscus::catalyst
