// Attributes of the vertices on the CPU, and normals in the same pass.
#include <cmath>

#include "steps/place_vertices/block_vertices.hpp"
#include "steps/place_vertices/cluster_sums.hpp"
#include "steps/place_vertices/place_vertices.hpp"

namespace meniscus::cpu {

void ClusterSums::write_values(const Member& member, unsigned group) {
    for (unsigned k = 0; k < numbers_.shape.count(group); ++k) {
        const AttributeNumber& number = numbers_.group(group)[k];
        number.write(mesh_.attributes[number.array].data.data(), blocks_.first_vertex[member.block],
                     values_.of[k] + member.first, static_cast<std::uint32_t>(member.count));
    }
}

void ClusterSums::write_normals(const Member& member) {
    Normal* const out = mesh_.normals.data() + blocks_.first_vertex[member.block];
    float sum = 0.0F;
    for (std::size_t i = 0; i < member.count; ++i) {
        const std::size_t at = member.first + i;
        out[i] = {x_[at], y_[at], z_[at]};
        sum += x_[at] + y_[at] + z_[at];
    }
    if (std::isfinite(sum) && !settings_.has_domain) return;
    BlockVertices vertices;
    find_vertices(blocks_, member.block, vertices);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = vertices.first[axis]; i < vertices.first[axis + 1]; ++i) {
            const bool is_cropped =
                settings_.has_domain && EdgeValues{vertices.low[i], vertices.high[i]}.cropped(settings_.iso);
            out[i] = outward_normal(out[i], is_cropped, static_cast<int>(axis),
                                    is_low_inside(blocks_, member.block, vertices, i));
        }
}

void ClusterSums::finish() {
    if (member_count_ == 0) return;
    const NormalRows normals{x_, y_, z_};
    const NormalRows* to_find = settings_.has_normals ? &normals : nullptr;
    for (unsigned group = 0; group < numbers_.shape.groups(); ++group) {
        // Means are found on the way to normals: both look at all particles near, and share their distances.
        const NormalRows* const on_the_way = numbers_.shape.are_ids(group) ? nullptr : to_find;
        const std::size_t lonely = field_.attributes(lowest_, points_, numbers_, group, on_the_way, values_, worker_);
        if (group == 0) without_particles_ += lonely;
        if (on_the_way != nullptr) to_find = nullptr;
        for (std::size_t m = 0; m < member_count_; ++m) write_values(members_[m], group);
    }
    if (to_find != nullptr) field_.normals(lowest_, points_, normals, worker_);
    for (std::size_t m = 0; settings_.has_normals && m < member_count_; ++m) write_normals(members_[m]);
    member_count_ = 0;
    points_.count = 0;
}

}  // namespace meniscus::cpu
