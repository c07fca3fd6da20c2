// The session's first thread: frames in their order and turn become meshes.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "log.hpp"
#include "meniscus/error.hpp"
#include "sessions/session.hpp"

namespace meniscus::server {

void Session::reconstruct_frames() {
    for (;;) {
        const FrameQueue::Next next = received_.wait();
        if (next == FrameQueue::Next::closed) return;
        if (next == FrameQueue::Next::note) {
            if (auto note = received_.take(next)) pass_on(std::move(*note));
            continue;
        }
        if (next_mesh_ == nullptr) {
            const auto mesh = free_frames_.take();
            if (!mesh) return;
            next_mesh_ = *mesh;
        }
        const Turns::Turn turn = shared_.turns->wait();
        // Only now, so that until its turn a frame can be replaced by a newer one.
        if (auto frame = received_.take(next); frame && !reconstruct_next(std::move(*frame))) return;
    }
}

void Session::pass_on(Received note) {
    if (note.max_level != 0)
        cap_levels_again(note.max_level);
    else if (note.particles)
        show_particles_again();
    else if (note.dropped)
        tasks_.put(ReportDrop{.upload = std::move(note.upload), .dropped = *note.dropped});
    else
        tasks_.put(EndUpload{.upload = std::move(note.upload), .error = std::move(note.error)});
}

bool Session::reconstruct_next(Received received) {
    InputFrame& input = *received.input;
    if (received.upload == failed_) {
        return_input(input);
        return true;
    }
    try {
        reconstruct(received, *next_mesh_);
    } catch (const DeviceError& error) {
        log_error({.session = id(), .frame = input.index}, "the session ends: {}", error.what());
        tasks_.put(EndSession{std::current_exception()});
        return false;
    } catch (...) {
        failed_ = received.upload;
        return_input(input);
        tasks_.put(EndUpload{.upload = failed_, .error = std::current_exception()});
        return true;
    }
    show(received);
    return_input(input);
    tasks_.put(Encode{.upload = std::move(received.upload), .frame = std::exchange(next_mesh_, nullptr)});
    return true;
}

void Session::reconstruct(const Received& received, ReconstructedFrame& frame) {
    const InputFrame& input = *received.input;
    try {
        Reconstructed reconstructed = functions_.reconstruct(input.view(), frame.mesh);
        frame.statistics = std::move(reconstructed.statistics);
        frame.download = std::move(reconstructed.download);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", input.index, error.what()));
    }
    frame.index = input.index;
    frame.run_id = received.upload->run->id;
    frame.simulation_time = input.simulation_time;
    frame.received_at = input.received_at;
    frame.number = ++reconstructed_;
    cap_levels(frame);
    const std::lock_guard lock(mutex_);
    ++state_.frames;
    state_.last_frame_index = input.index;
}

void Session::show(const Received& received) {
    InputFrame& input = *received.input;
    Run& run = *received.upload->run;
    if (run.last_shown && input.index <= *run.last_shown) return;
    run.last_shown = input.index;
    if (observer_) observer_->reconstructed(input);
    input.shown_in_run = run.id;
    newest_input_ = &input;
    decltype(particles_) before;  // destroyed outside of the lock
    {
        const std::lock_guard lock(mutex_);
        particles_.swap(before);
    }
    show_particles(input);
}

void Session::cap_levels(ReconstructedFrame& frame) {
    for (const int max_level : {1, 2}) {
        auto& capped = frame.capped_at(max_level);
        capped.made = is_wished_for(max_level) && emit_capped(max_level, capped.mesh);
        if (!capped.made) capped.mesh = {};  // nobody's memory
    }
}

void Session::cap_levels_again(int max_level) {
    if (reconstructed_ == 0) return;
    const Turns::Turn turn = shared_.turns->wait();
    AddCapped task{.frame_number = reconstructed_, .max_level = max_level, .mesh = {}};
    try {
        if (emit_capped(max_level, task.mesh)) tasks_.put(std::move(task));
    } catch (const DeviceError& error) {
        log_error({.session = id()}, "the session ends: {}", error.what());
        tasks_.put(EndSession{std::current_exception()});
    }
}

bool Session::emit_capped(int max_level, Mesh& mesh) {
    try {
        functions_.emit_capped(max_level, mesh);
        return true;
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = id()}, "no mesh of levels up to {} for its watchers, who keep the one before: {}",
                  max_level, error.what());
        return false;
    }
}

bool Session::is_wished_for(int max_level) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(watches_,
                               [&](const auto& watch) { return watch->wishes().format.max_level == max_level; });
}

}  // namespace meniscus::server
