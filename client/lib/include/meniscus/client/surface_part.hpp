// What one of several publishers has of a surface, encoded.
#pragma once

#include <cstdint>
#include <span>

#include "meniscus/brick_box.hpp"
#include "meniscus/client/received_frame.hpp"

namespace meniscus::client {

/// As encode_frame(), of some bricks of the mesh. part: part_of() it.
ReceivedFrame encode_part(const Mesh& mesh, SurfacePart part, std::uint64_t index, double simulation_time,
                          CodingOptions options = {});

/// What Publisher::push() sends of a mesh: its bricks in the box, with the attributes that are wished. Throws
/// InvalidInput for a mesh without its lattice (BackendOptions::keep_lattice).
ReceivedFrame encode_own(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                         const BrickBox& own, CodingOptions options, std::span<const AttributeWish> wishes);

}  // namespace meniscus::client
