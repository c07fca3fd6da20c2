// Frames of a running simulation in parts, reconstructed beside it: processes exchange when the simulation calls, and
// their threads make the parts between the calls. (core/README.md#beside-a-simulation)
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"

namespace meniscus {

/// What becomes of frames that come faster than they are reconstructed.
enum class LivePolicy : std::uint8_t {
    latest,       ///< they are left out, by all processes together: push() waits for no reconstruction
    every_frame,  ///< none is lost: push() waits for the frame before
};

/// A process's part of a frame whose seams are all equal.
struct LivePart {
    std::uint64_t index = 0;
    double simulation_time = 0.0;
    const Mesh* mesh;        ///< null where the frame has fewer parts than there are makers
    std::size_t number = 0;  ///< of the part, if there is one: below the size of report.own_vertices
    /// Of the part, such that all parts' add up to the whole frame's: what belongs to no part is counted by the first.
    Statistics statistics;
    const PartsReport& report;  ///< the whole frame's
};

/// Shows frames. Its functions are called in makers, on one thread at a time, which is the caller's of push() only
/// where the system refuses another.
class LivePublisher {
public:
    virtual ~LivePublisher() = default;
    /// The frame is there when all makers have published their part of it. What is thrown is told by a push() that
    /// follows, in all processes.
    virtual void publish(const LivePart& part) = 0;
    /// The publisher of some maker has failed: closes what is open.
    virtual void abandon() noexcept = 0;
    /// What was published last is published by all makers. Called while neither of the others runs, also more than
    /// once.
    virtual void confirm() noexcept {}
    /// Whether no frame need be made now, since none could be published. Called by push(), while neither of
    /// the others runs.
    virtual bool is_away() const noexcept { return false; }
};

/// A part could not be published. All processes throw it together, with the rank in the message.
class PublishingFailed : public ProcessFailed {
public:
    using ProcessFailed::ProcessFailed;
};

/// One in each process of an exchange, each with the same settings and options. All functions are called by all
/// processes together, in the same order; the exchange is used in them alone, on the thread that calls.
///
/// A frame's particles are copied by the push() that brings it. With `latest` they go to those that make its parts in
/// the push() after that, for which each process's thread chooses them meanwhile; with `every_frame` at once. A frame's
/// seams are compared in the push() after its particles have gone, and it is published then. finish() does the same.
class LiveParts {
public:
    /// exchange, publisher: must stay. options: as many parts as makers. Throws as PartsReconstructor.
    LiveParts(const Settings& settings, const BackendOptions& backend, const PartsOptions& options, LivePolicy policy,
              PartExchange& exchange, LivePublisher& publisher);
    /// Waits for what is being made, without the others.
    ~LiveParts();

    /// mine: gives the particles of this process, if the frame is not left out: what does not stay is copied. index:
    /// greater than the one before; index and time are the same in all processes. False: the frame is left out, in all
    /// of them.
    ///
    /// An error of one process is thrown by all, with its rank: InvalidInput for particles, an index or a time that
    /// cannot be, and errors of the frames before, PublishingFailed among them, or that their encodings differ from
    /// process to process. This frame is then left out, and the next may come.
    bool push(const FrameGiver& mine, std::uint64_t index, double simulation_time);
    bool push(const ParticleFrame& mine, std::uint64_t index, double simulation_time) {
        return push([&mine] { return mine; }, index, simulation_time);
    }
    /// Waits until all that was pushed has been published. Throws likewise, the first error of frames that fail; the
    /// others are published all the same.
    void finish();
    /// The least that the next frame may have, the same in all processes.
    std::uint64_t next_index() const;
    /// Frames left out so far.
    std::uint64_t dropped() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
