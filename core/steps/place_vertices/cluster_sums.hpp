// Normals and attributes of vertices on the CPU: both are sums over the particles near a vertex.
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/lattice_settings.hpp"
#include "lattice/blocks.hpp"
#include "meniscus/mesh.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "neighbors/cpu/field_source.hpp"
#include "particles/attributes.hpp"

namespace meniscus::cpu {

/// Normals and attributes of a cluster's vertices: most blocks have too few of them to fill registers, and neighbors
/// share the particles near them.
class ClusterSums {
public:
    ClusterSums(const BlocksView& blocks, const LatticeSettings& settings, const AttributeNumbers& numbers,
                FieldSource& field, Mesh& mesh, unsigned worker)
        : blocks_(blocks), settings_(settings), numbers_(numbers), field_(field), mesh_(mesh), worker_(worker) {}

    /// lowest: base cell of the cluster.
    void begin(const Int3& lowest) { lowest_ = lowest; }

    /// points: those of a block's vertices, relative to the block's corner.
    void add(std::uint32_t block, const PointList& points) {
        if (!settings_.has_normals && numbers_.shape.groups() == 0) return;
        if (points_.count + points.count > max_points) finish();
        const Int3 step = blocks_.coordinate(block) - lowest_;
        const float x = static_cast<float>(step.x) * base_edge, y = static_cast<float>(step.y) * base_edge,
                    z = static_cast<float>(step.z) * base_edge;
        members_[member_count_++] = {block, points_.count, points.count};
        for (std::size_t i = 0; i < points.count; ++i) {
            points_.x[points_.count + i] = points.x[i] + x;
            points_.y[points_.count + i] = points.y[i] + y;
            points_.z[points_.count + i] = points.z[i] + z;
        }
        points_.count += points.count;
    }

    /// Writes the normals and attributes of all blocks added.
    void finish();

    /// Vertices that no particle is near.
    std::uint64_t without_particles() const { return without_particles_; }

private:
    struct Member {
        std::uint32_t block;
        std::size_t first, count;  ///< its points
    };

    void write_values(const Member& member, unsigned group);
    /// The field's normals, or along the edge where the domain's border or a vanishing gradient leaves none.
    void write_normals(const Member& member);

    const BlocksView& blocks_;
    const LatticeSettings& settings_;
    const AttributeNumbers& numbers_;
    FieldSource& field_;
    Mesh& mesh_;
    std::size_t member_count_ = 0;
    std::uint64_t without_particles_ = 0;
    Int3 lowest_{};
    unsigned worker_;
    Member members_[cluster_blocks];
    PointList points_;
    alignas(64) float x_[max_points];
    alignas(64) float y_[max_points];
    alignas(64) float z_[max_points];
    GroupValues values_;
};

}  // namespace meniscus::cpu
