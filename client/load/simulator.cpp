#include "load/simulator.hpp"

#include <thread>

namespace meniscus::load {

namespace {

std::uint64_t bytes_of(const ParticleFrame& frame) {
    return frame.positions.size_bytes() + frame.quantized.size_bytes() + frame.levels.size_bytes();
}

/// The outcome without the figures that come with the answers.
UploadOutcome send(client::Stream& stream, const Frames& frames, const Schedule& schedule) {
    UploadOutcome outcome;
    std::uint64_t frame = 0;
    try {
        for (; frame < schedule.frames; ++frame) {
            const Clock::time_point due = schedule.due(frame);
            std::this_thread::sleep_until(due);
            const Clock::time_point now = Clock::now();
            if (now > schedule.due(schedule.frames)) break;
            if (schedule.measured(frame)) outcome.send_delay.add(seconds_between(due, now));
            const ParticleFrame particles = frames.at(frame);
            stream.push(particles, frame, seconds_between(schedule.start, due));
            ++outcome.sent;
            outcome.particles += particles.count();
            outcome.upload_bytes += bytes_of(particles);
        }
        stream.finish();
    } catch (...) {
        // The answers' side gets the same error, and counts it.
    }
    outcome.not_sent = schedule.frames - outcome.sent;
    return outcome;
}

/// Until the stream ends.
UploadOutcome receive(client::Stream& stream, const Schedule& schedule) {
    UploadOutcome outcome;
    try {
        while (const auto frame = stream.next()) {
            outcome.last_answer = Clock::now();
            if (schedule.measured(frame->index))
                outcome.answer.add(seconds_between(schedule.due(frame->index), outcome.last_answer));
            ++outcome.answered;
            outcome.mesh_bytes += frame->statistics.encoded_bytes;
        }
    } catch (...) {
        count_error(outcome.errors, std::current_exception());
    }
    outcome.dropped = stream.dropped();
    return outcome;
}

}  // namespace

UploadOutcome simulate(client::Client& client, const std::string& session, const client::StreamOptions& options,
                       const Frames& frames, const Schedule& schedule) {
    client::Stream stream = client.stream(session, options);
    UploadOutcome received;
    std::thread receiving([&] { received = receive(stream, schedule); });
    UploadOutcome outcome = send(stream, frames, schedule);
    receiving.join();
    outcome.add(received);
    return outcome;
}

}  // namespace meniscus::load
