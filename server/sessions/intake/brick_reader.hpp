// Finished bricks as they arrived become a frame, or a refusal: the edge at which what they claim is verified.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "meniscus/memory.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/stop_flag.hpp"
#include "sessions/handover/worker_pool.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/intake/open_edges.hpp"
#include "sessions/sending/frame_encoder.hpp"
#include "sessions/sending/scratch_pool.hpp"

namespace meniscus::server {

/// Reads the frames of one session, one after the other. Each brick is decoded once: one of the frame before is known
/// by its bytes.
class BrickReader {
public:
    enum class Check : bool { each_brick, closed_surface };

    /// account: of the memory that bricks are kept and decoded in; stop: ends the reading of a frame early. Both may be
    /// none.
    BrickReader(const Settings& settings, Check check, std::shared_ptr<WorkerPool> workers,
                std::shared_ptr<MemoryAccount> account, std::shared_ptr<StopFlag> stop)
        : settings_(settings),
          check_(check),
          workers_(std::move(workers)),
          scratch_(std::move(account)),
          stop_(std::move(stop)) {}

    /// Makes the frame's surface and statistics. input: of finished bricks, complete. Throws InvalidInput for what is
    /// no surface of these settings, with the brick's place and its part, LimitExceeded for memory, and Stopped.
    void read(const InputFrame& input, ReconstructedFrame& frame);
    /// Frees the memory that it works in; the bricks of the last frame stay known.
    void release_memory() { scratch_.release_memory(); }
    /// Frees all of it.
    void forget() {
        known_.clear();
        scratch_.release_memory();
    }

private:
    struct Brick {
        EncodedBrick encoded;
        std::uint32_t part = 0;
    };
    struct Known {
        SharedBrick messages;
        std::shared_ptr<const OpenEdges> open;  ///< where the surface is checked
    };

    std::vector<Brick> bricks_of(const InputFrame& input, Array<Point>& spray) const;
    void stop_if_asked() const;
    void require_in_domain(const EncodedBrick& brick) const;
    /// The attributes of a frame, as its bricks carry them. Throws InvalidInput for others than frames before it had.
    std::vector<CodedAttribute> attributes_of(std::span<const BrickPart> parts) const;
    Known checked(const Brick& brick, const std::vector<CodedAttribute>& attributes, const Known* before);

    const Settings settings_;
    const Check check_;
    const std::shared_ptr<WorkerPool> workers_;
    ScratchPool scratch_;
    const std::shared_ptr<StopFlag> stop_;
    std::vector<Known> known_;                ///< of the last frame, ordered by place
    std::vector<CodedAttribute> attributes_;  ///< of the last frame that had any
};

}  // namespace meniscus::server
