// A frame as it comes from a server or out of a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::client {

enum class DropReason {
    replaced,    ///< UploadPolicy::latest
    not_nth,     ///< UploadPolicy::every_nth
    incomplete,  ///< of StreamOptions::parts: another part has left it out, or had its answer before a break
};

/// A frame that the server left out, as the policy says.
struct DroppedFrame {
    std::uint64_t index = 0;
    DropReason reason = DropReason::replaced;
};

/// An attribute of a received frame's mesh, whether it was asked for or not.
struct FrameAttribute {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;  ///< numbers per vertex
    /// Over the vertices of the whole surface, whatever a watcher has of it; none where it has no vertices.
    std::optional<AttributeRange> range{};
};

/// One received frame. Bricks stay encoded until they are asked for.
struct ReceivedFrame {
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;  ///< of the run of frames that the simulator sends; 0: of no run
    double simulation_time = 0.0;
    double cell_size = 0.0;
    std::uint32_t offset_bits = 0;
    /// All of them, ordered by coordinate (z, y, x); empty when no meshes were asked for. A watcher's frames share
    /// those that did not change.
    std::vector<std::shared_ptr<const EncodedBrick>> bricks;
    /// Places of the particles left out of the surface (Spray::points), world units; empty when not asked for.
    std::vector<Point> spray;
    std::vector<FrameAttribute> attributes;  ///< in the order of the session's settings
    /// The attributes that were asked for, as the bricks carry them; empty when no meshes were asked for.
    std::vector<CodedAttribute> coded_attributes;
    /// To a watcher: the bricks that are new or were received anew since the frame that next() returned before, and
    /// those of that frame which are there no longer. x y z in bricks.
    std::vector<std::array<std::int32_t, 3>> changed;
    std::vector<std::array<std::int32_t, 3>> vanished;
    FrameStatistics statistics;         ///< of the frame as reconstructed, whatever a watcher asks for
    std::vector<DroppedFrame> dropped;  ///< from a Stream: between the frame received before and this one, in order
    NormalsBy normals_by = NormalsBy::server;  ///< receiver: mesh() computes them, whatever the bricks carry

    /// Decodes and welds the bricks; has the spray and the attributes that were asked for, too. Throws InvalidInput if
    /// they are not a mesh.
    Mesh mesh() const;
};

/// A surface that was reconstructed here, encoded as a server would: with Draco where the codec needs a lattice that
/// the mesh lacks (BackendOptions::keep_lattice). Its bricks carry options.attributes alone.
ReceivedFrame encode_frame(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                           CodingOptions options = {});

}  // namespace meniscus::client
