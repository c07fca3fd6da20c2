// A frame reconstructed in parts, one after the other in each process that takes part, and compared at their seams.
// (core/README.md#parts-that-are-put-together)
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/part.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

inline constexpr std::size_t max_parts = 65536;

/// What the processes that make one surface tell each other. All of them call the same functions in the same order.
class PartExchange {
public:
    using Bytes = std::vector<std::byte>;

    virtual ~PartExchange() = default;
    virtual std::size_t rank() const = 0;   ///< number of this process, from 0
    virtual std::size_t ranks() const = 0;  ///< number of processes
    /// The bytes of all, by rank: small things.
    virtual std::vector<Bytes> gather(Bytes mine) = 0;
    /// to: what each rank shall get, by rank: particles. from: gets as many elements as there are ranks, and what each
    /// has sent to this one in place of what was there. The memory of both serves the next call; they may have swapped
    /// it.
    virtual void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) = 0;
};
/// The exchange of a process by itself.
class AloneExchange final : public PartExchange {
public:
    std::size_t rank() const override { return 0; }
    std::size_t ranks() const override { return 1; }
    std::vector<Bytes> gather(Bytes mine) override;
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override { to.swap(from); }
};

struct PartsOptions {
    std::size_t parts = 1;                    ///< of all processes together, 1 to max_parts
    std::uint32_t overlap = default_overlap;  ///< of a part that is made the first time, base cells
    std::vector<std::size_t> makers{};        ///< ranks of the processes that make parts, ascending; empty: all
};

/// A part that has been made. It is made once more if a seam of it differs from that of the part beyond, and then takes
/// the place of what it was.
struct FinishedPart {
    std::size_t number;  ///< from 0, among all parts
    const FramePart& part;
    Mesh& mesh;  ///< which may be changed, or taken
    const Statistics& statistics;
};
using PartSink = std::function<void(const FinishedPart&)>;
/// A frame that stays for the time of the call; by itself nothing of it does longer. What stays until the next frame
/// but one is asked for is not copied.
struct HandedFrame {
    ParticleFrame frame;
    bool positions_stay = false;
    bool rest_stays = false;  ///< levels and arrays

    HandedFrame(const ParticleFrame& handed, bool its_positions_stay = false, bool its_rest_stays = false)
        : frame(handed), positions_stay(its_positions_stay), rest_stays(its_rest_stays) {}
};
/// Its error is thrown by all processes.
using FrameGiver = std::function<HandedFrame()>;

/// Figures of a frame in parts, over all processes, of parts as they were made last.
struct PartsReport {
    /// Of the whole frame. Evaluations and times are sums over the parts: what two of them sample, both count, as they
    /// do a border's vertices without particles. Memory is this process's. Warnings are there where one process takes
    /// part.
    Statistics whole;
    std::uint64_t particles_received = 0;  ///< of all parts: each gets those around it, too
    std::uint64_t parts_made = 0;          ///< those that were made once more counted again
    std::uint64_t unequal_seams = 0;       ///< seams that differed, all rounds together
    std::uint32_t greatest_overlap = 0;    ///< base cells
    /// Of each part, by number, the vertices that no part before it has: they add up to the whole's.
    std::vector<std::uint64_t> own_vertices;
    std::vector<AttributeRange> ranges;  ///< of each attribute over all vertices; none without vertices
    std::uint64_t farthest = 0;          ///< greatest magnitude of a vertex's coordinate, lattice units
};

/// Reconstructs frames in parts; one in each process of an exchange, each with the same settings and options. A process
/// makes its parts in turn: of those it has as many as the other makers, or one more, and they are those in which it
/// has most particles, as far as that goes.
///
/// Where one process throws, all throw, with its rank in the message; then the frame is over, and another may begin.
class PartsReconstructor {
public:
    /// exchange: must stay. Throws InvalidInput as Reconstructor does, and for a number of parts, an overlap or makers
    /// out of range.
    PartsReconstructor(const Settings& settings, const BackendOptions& backend, const PartsOptions& options,
                       PartExchange& exchange);
    ~PartsReconstructor();

    /// mine: the particles of this process, each once among all processes, wherever they are. sink: gets this process's
    /// parts. Throws as Reconstructor::reconstruct_part(), and InvalidInput where the processes' frames differ in their
    /// encoding.
    PartsReport reconstruct(const ParticleFrame& mine, const PartSink& sink);

    // The same in steps, which may lie apart in time: begin(), prepare() and bring(), then make() and go_on() in turn
    // until there is nothing to make. All processes call begin(), bring() and go_on() together, one after the other;
    // prepare() and make() are each one's own, and any thread's, one at a time. A frame may be begun and prepared while
    // the one before it is made.

    /// Copies the particles that do not stay.
    void begin(const FrameGiver& mine);
    /// Deals bricks to parts, and chooses the particles for each. What goes wrong is thrown by bring(): also that the
    /// processes' frames differ in their encoding.
    void prepare() noexcept;
    /// Brings the first particles to those that make parts of them. The frame before must have ended.
    void bring();
    /// Makes a part of these particles, if this process has one to make now. What goes wrong is thrown by go_on().
    void make(const PartSink& sink) noexcept;
    /// Brings the particles for more parts, and returns true; once all are made and their seams are equal, false.
    bool go_on();
    /// Of the frame that has ended last. Its parts' figures are summed up here: on any thread, but not during go_on().
    PartsReport report() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// The mesh of the whole frame of the meshes of all its parts, in the order of vertices and triangles that
/// Reconstructor::reconstruct() gives, and with what it has but the lattice. Throws InvalidInput for meshes of
/// different lattices or with different attributes, and LimitExceeded for more vertices or triangles than can be
/// numbered.
Mesh put_together(std::span<const Mesh> parts);

}  // namespace meniscus
