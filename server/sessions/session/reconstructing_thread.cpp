#include "sessions/session/reconstructing_thread.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/seconds.hpp"
#include "process/call_log.hpp"
#include "process/log.hpp"
#include "process/open_work.hpp"
#include "sessions/handover/start_thread.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

/// Limits the memory of a reconstruction for a turn: beside one that leads, to the eighth that no other session may
/// take.
class MemoryOfTurn {
public:
    /// is_less: becomes whether the session may have more in a turn that leads, for as long as this limits it.
    MemoryOfTurn(const ReconstructFunctions& functions, const Limits& limits, bool leads, bool& is_less)
        : functions_(functions), own_(limits.bytes_per_session), is_less_(is_less) {
        const std::size_t beside = an_eighth(limits.total_bytes);
        is_less_ = !leads && functions.limit_memory && beside != 0 && (own_ == 0 || beside < own_);
        if (is_less_) functions.limit_memory(beside);
    }
    ~MemoryOfTurn() {
        if (std::exchange(is_less_, false)) functions_.limit_memory(own_);
    }
    MemoryOfTurn(const MemoryOfTurn&) = delete;
    MemoryOfTurn& operator=(const MemoryOfTurn&) = delete;

private:
    const ReconstructFunctions& functions_;
    const std::size_t own_;
    bool& is_less_;
};

}  // namespace

ReconstructingThread::ReconstructingThread(const SessionContext& context, ReconstructFunctions functions,
                                           FrameQueue& received, InputSlots& inputs, Watchers& watchers,
                                           EncodingThread& encoding, FrameStop& stop)
    : context_(context),
      functions_(std::move(functions)),
      received_(received),
      inputs_(inputs),
      watchers_(watchers),
      encoding_(encoding),
      stop_(stop),
      bricks_(context.settings,
              context.limits.check_published ? BrickReader::Check::closed_surface : BrickReader::Check::each_brick,
              context.shared.workers,
              std::make_shared<MemoryAccount>(context.limits.bytes_per_session, "to check its bricks",
                                              context.shared.memory),
              functions_.stop),
      particles_(context.identity.id, context.settings.particle_radius, inputs, watchers, context.observers),
      thread_(start_thread(fmt::format("that reconstructs session {}", context.identity.id), [this] { run(); })) {}

ReconstructingThread::Progress ReconstructingThread::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

void ReconstructingThread::join() {
    if (thread_.joinable()) thread_.join();
}

void ReconstructingThread::release_memory() {
    functions_ = {};
    bricks_.forget();
    particles_.forget();
}

void ReconstructingThread::run() {
    for (;;) {
        const FrameQueue::Next next = received_.wait();
        if (next == FrameQueue::Next::closed) return;
        if (next == FrameQueue::Next::note) {
            if (auto note = received_.take(next)) pass_on(std::move(*note));
            continue;
        }
        if (next_mesh_ == nullptr) next_mesh_ = encoding_.wait_for_free_frame();
        if (next_mesh_ == nullptr) return;
        auto turn = begin_work();
        if (!turn) return;
        // Only now, so that until its turn a frame can be replaced by a newer one.
        if (auto frame = received_.take(next); frame && !reconstruct_next(std::move(*frame), *std::move(turn))) return;
        rest();
    }
}

void ReconstructingThread::pass_on(Received note) {
    if (note.release)
        release_buffers();
    else if (note.watchers)
        serve_watchers();
    else if (note.dropped)
        encoding_.put(EncodingThread::ReportDrop{.upload = std::move(note.upload), .dropped = *note.dropped});
    else
        encoding_.put(EncodingThread::EndUpload{.upload = std::move(note.upload), .error = std::move(note.error)});
}

bool ReconstructingThread::reconstruct_next(Received received, Turns::Turn turn) {
    InputFrame& input = *received.input;
    if (received.upload == failed_) {
        inputs_.give_back(input);
        return true;
    }
    try {
        // The rest is no work of the device: others have their turn meanwhile.
        const bool done = in_turn(std::move(turn), [&] {
            const FrameStop::UnderWay under_way(stop_, received.upload.get());
            const OpenWork::Entry working(open_work(), fmt::format("the reconstruction of frame {} of session {}",
                                                                   input.index, context_.identity.id));
            reconstruct(received, *next_mesh_);
        });
        if (!done) {
            inputs_.give_back(input);
            return false;
        }
    } catch (const DeviceError& error) {
        log_error({.session = context_.identity.id, .frame = input.index}, "the session ends: {}", error.what());
        inputs_.give_back(input);
        encoding_.put(EncodingThread::EndSession{std::current_exception()});
        return false;
    } catch (...) {
        failed_ = received.upload;
        inputs_.give_back(input);
        encoding_.put(EncodingThread::EndUpload{.upload = failed_, .error = std::current_exception()});
        return true;
    }
    const bool shown = particles_.show(input, *received.upload->run);
    if (shown) {
        shown_ = {.number = next_mesh_->number, .run_id = next_mesh_->run_id, .statistics = next_mesh_->statistics};
        meshes_released_ = false;
    }
    // Its simulator's answer first: watchers may ask for much.
    encoding_.put(
        EncodingThread::Encode{.upload = std::move(received.upload), .frame = std::exchange(next_mesh_, nullptr)});
    if (shown) particles_.encode(input);
    inputs_.give_back(input);
    return true;
}

bool ReconstructingThread::in_turn(std::optional<Turns::Turn> turn, const std::function<void()>& work) {
    if (!turn) return false;
    {
        const MemoryOfTurn memory(functions_, context_.limits, turn->leads(), may_have_more_memory_);
        try {
            const Turns::Turn ends = *std::move(turn);
            work();
            return true;
        } catch (const MemoryLimitExceeded&) {
            if (!may_have_more_memory_) throw;
        }
    }
    return in_turn(begin_work(Turns::Needs::to_lead), work);
}

void ReconstructingThread::reconstruct(const Received& received, ReconstructedFrame& frame) {
    InputFrame& input = *received.input;
    const bool had_surface = std::exchange(has_surface_, false);
    try {
        make_surface(input, frame);
    } catch (const InvalidInput& error) {
        has_surface_ = had_surface;  // the one before
        throw InvalidInput(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const MemoryLimitExceeded& error) {
        throw MemoryLimitExceeded(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const Stopped&) {
        throw_stopped(input.index);
    }
    frame.index = input.index;
    frame.run_id = received.upload->run->id;
    frame.simulation_time = input.simulation_time;
    frame.received_at = input.received_at;
    frame.number = progress_.frames + 1;
    if (has_surface_) cap_levels(frame);
    const std::lock_guard lock(mutex_);
    progress_ = {.frames = frame.number, .last_frame_index = input.index};
}

void ReconstructingThread::make_surface(InputFrame& input, ReconstructedFrame& frame) {
    has_finished_bricks_ = !input.brick_parts.empty();
    if (has_finished_bricks_) return bricks_.read(input, frame);
    input.pin();
    Reconstructed reconstructed = functions_.reconstruct(input.view(), frame.mesh);
    frame.statistics = std::move(reconstructed.statistics);
    frame.download = std::move(reconstructed.download);
    has_surface_ = true;
}

void ReconstructingThread::throw_stopped(std::uint64_t index) const {
    const std::string& id = context_.identity.id;
    switch (stop_.reason()) {
        case FrameStop::Reason::too_long: {
            const double seconds = seconds_of(context_.limits.frame_time);
            log_warning({.session = id, .frame = index}, "stopped: it had the device for {:.3g} s", seconds);
            throw LimitExceeded(fmt::format(
                "frame {}: it has had the device for {:.3g} s, as long as the server gives to one frame: use "
                "a larger cell size or fewer particles",
                index, seconds));
        }
        case FrameStop::Reason::closed:
            throw session_ended(id, {});
        case FrameStop::Reason::canceled:
        case FrameStop::Reason::none:
            break;
    }
    call_log.write({.session = id, .frame = index}, "stopped: its stream was canceled");
    throw Refusal(Refusal::Kind::unavailable, fmt::format("frame {}: its stream was canceled", index));
}

void ReconstructingThread::cap_levels(ReconstructedFrame& frame) {
    for (const int max_level : {1, 2}) {
        auto& capped = frame.capped_at(max_level);
        capped.made = watchers_.want_level(max_level) && emit_capped(max_level, capped.mesh);
        if (!capped.made) capped.mesh = {};  // nobody's memory
        capped_.at(static_cast<std::size_t>(max_level - 1)) = capped.made;
    }
}

void ReconstructingThread::serve_watchers() {
    particles_.show_again();
    if (!watchers_.unpublished_formats().empty()) make_meshes_again();
    for (const int max_level : {1, 2}) cap_levels_again(max_level);
}

void ReconstructingThread::cap_levels_again(int max_level) {
    bool& made = capped_.at(static_cast<std::size_t>(max_level - 1));
    if (!has_surface_ || made || !watchers_.want_level(max_level)) return;
    const auto turn = begin_work();
    if (!turn) return;
    const FrameStop::UnderWay under_way(stop_, nullptr);
    EncodingThread::AddCapped task{.frame_number = progress_.frames, .max_level = max_level, .mesh = {}};
    try {
        made = emit_capped(max_level, task.mesh);
        if (made) encoding_.put(std::move(task));
    } catch (const DeviceError& error) {
        log_error({.session = context_.identity.id}, "the session ends: {}", error.what());
        encoding_.put(EncodingThread::EndSession{std::current_exception()});
    }
    rest();
}

std::optional<Turns::Turn> ReconstructingThread::begin_work(Turns::Needs needs) {
    {
        const std::lock_guard lock(mutex_);
        resting_since_.reset();
    }
    waits_for_turn_ = true;
    const SessionIdentity& identity = context_.identity;
    auto turn = context_.shared.turns->wait(context_.closing, identity.account ? identity.account->name() : identity.id,
                                            identity.id, needs);
    waits_for_turn_ = false;
    return turn;
}

void ReconstructingThread::rest() {
    const std::lock_guard lock(mutex_);
    resting_since_ = Clock::now();
}

std::optional<ReconstructingThread::Clock::time_point> ReconstructingThread::resting_since() const {
    const std::lock_guard lock(mutex_);
    return resting_since_;
}

void ReconstructingThread::release_buffers() {
    {
        const std::lock_guard lock(mutex_);
        if (!resting_since_) return;
    }
    if (!functions_.release_memory) return;
    // The newest particles may have been overwritten by a frame that was refused. Their mesh stays then.
    const bool can_make_again = progress_.frames == 0 || (!has_finished_bricks_ && particles_.keep());
    // Meshes first: a download reads the reconstruction's memory.
    if (!encoding_.release_meshes(can_make_again ? EncodingThread::Newest::release : EncodingThread::Newest::keep))
        return;
    functions_.release_memory();
    bricks_.release_memory();
    inputs_.release_memory();
    meshes_released_ = progress_.frames != 0 && can_make_again;
    has_surface_ = false;
    const std::lock_guard lock(mutex_);
    resting_since_.reset();
}

void ReconstructingThread::make_meshes_again() {
    const InputFrame* const input = particles_.kept();
    if (!meshes_released_ || input == nullptr) return;
    if (next_mesh_ == nullptr) next_mesh_ = encoding_.wait_for_free_frame();
    if (next_mesh_ == nullptr) return;
    try {
        const bool done = in_turn(begin_work(), [&] {
            const FrameStop::UnderWay under_way(stop_, nullptr);
            ReconstructedFrame& frame = *next_mesh_;
            frame.download = functions_.reconstruct(input->view(), frame.mesh).download;
            has_surface_ = true;
            frame.statistics = shown_.statistics;
            frame.index = input->index;
            frame.run_id = shown_.run_id;
            frame.simulation_time = input->simulation_time;
            frame.received_at = input->received_at;
            frame.number = shown_.number;
            cap_levels(frame);
            encoding_.put(EncodingThread::ShowAgain{.frame = std::exchange(next_mesh_, nullptr)});
            meshes_released_ = false;
        });
        if (!done) return;
    } catch (const DeviceError& error) {
        log_error({.session = context_.identity.id}, "the session ends: {}", error.what());
        encoding_.put(EncodingThread::EndSession{std::current_exception()});
    } catch (const Stopped&) {
        // Where the session ends, no watcher is left to miss it.
        if (stop_.reason() == FrameStop::Reason::too_long)
            log_warning({.session = context_.identity.id, .frame = input->index},
                        "no mesh for a watcher that has come, until the next frame: it had the device for too long");
    } catch (const std::exception& error) {
        log_error({.session = context_.identity.id, .frame = input->index},
                  "no mesh for a watcher that has come, until the next frame: {}", error.what());
    }
    rest();
}

bool ReconstructingThread::emit_capped(int max_level, Mesh& mesh) {
    try {
        functions_.emit_capped(max_level, mesh);
        return true;
    } catch (const DeviceError&) {
        throw;
    } catch (const Stopped&) {
        has_surface_ = false;
        if (stop_.reason() == FrameStop::Reason::too_long)
            log_warning({.session = context_.identity.id},
                        "no mesh of levels up to {} for its watchers, who keep the one before: it had the device for "
                        "too long",
                        max_level);
        return false;
    } catch (const std::exception& error) {
        has_surface_ = false;
        if (may_have_more_memory_ && dynamic_cast<const MemoryLimitExceeded*>(&error) != nullptr) throw;
        log_error({.session = context_.identity.id},
                  "no mesh of levels up to {} for its watchers, who keep the one before: {}", max_level, error.what());
        return false;
    }
}

}  // namespace meniscus::server
