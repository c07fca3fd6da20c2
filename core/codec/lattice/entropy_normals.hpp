// The entropy profile's last section: normals as residuals to what the brick's own triangles show.
//
// A vertex's normal is predicted from its triangles, crack filling excepted (corner_normals.hpp). All operations are
// exact or rounded once, so that encoder and decoder predict the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "codec/lattice/bit_stream.hpp"
#include "codec/lattice/corner_normals.hpp"
#include "codec/lattice/entropy_tables.hpp"
#include "codec/lattice/lattice_brick.hpp"
#include "codec/lattice/octahedron.hpp"

namespace meniscus {

inline constexpr int most_coded_normal_bits = 8;  ///< of more the lowest bits are sent as they are

/// Sums over the triangles around each vertex.
struct PredictedNormal {
    std::array<float, 3> sum{};
    float magnitudes = 0.0F;  ///< of the summands, |x| + |y| + |z|
};

/// Positions and triangles of the brick are there.
inline void predict_normals(const LatticeBrick& brick, std::vector<PredictedNormal>& normals) {
    normals.assign(brick.positions.size(), {});
    for (std::size_t t = 0; t < brick.triangles.size(); ++t) {
        if (brick.levels[t] == TriangleLevel::crack) continue;
        const Triangle& triangle = brick.triangles[t];
        const auto add = [&](std::size_t corner, const std::array<float, 3>& part) {
            PredictedNormal& at = normals[triangle[corner]];
            for (std::size_t k = 0; k < 3; ++k) {
                at.sum[k] += part[k];
                at.magnitudes += std::abs(part[k]);
            }
        };
        add_corner_normals<float>(
            {brick.positions[triangle[0]], brick.positions[triangle[1]], brick.positions[triangle[2]]}, add);
    }
}

/// The octahedron's surface unfolded around the face of one of its corners: s and t up to the radius.
class UnfoldedOctahedron {
public:
    UnfoldedOctahedron(int radius, const Octahedron::Point& middle) : radius_(radius) {
        for (std::size_t k = 1; k < 3; ++k)
            if (std::abs(middle[k]) > std::abs(middle[axis_])) axis_ = k;
        sign_ = middle[axis_] < 0 ? -1 : 1;
    }
    std::array<int, 2> place(const Octahedron::Point& p) const {
        const int u = p[(axis_ + 1) % 3];
        const int v = p[(axis_ + 2) % 3];
        if (p[axis_] * sign_ >= 0) return {u, v};
        return {sign_of(u) * (radius_ - std::abs(v)), sign_of(v) * (radius_ - std::abs(u))};
    }
    Octahedron::Point point(const std::array<int, 2>& place) const {
        const auto [s, t] = place;
        const int rest = radius_ - std::abs(s) - std::abs(t);
        Octahedron::Point p{};
        p[axis_] = sign_ * rest;
        p[(axis_ + 1) % 3] = rest >= 0 ? s : sign_of(s) * (radius_ - std::abs(t));
        p[(axis_ + 2) % 3] = rest >= 0 ? t : sign_of(t) * (radius_ - std::abs(s));
        return p;
    }

private:
    static int sign_of(int x) { return x < 0 ? -1 : 1; }

    int radius_;
    std::size_t axis_ = 0;
    int sign_ = 1;
};

using NormalIndex = SymbolIndex<residuals, 2 * flatness_classes * normal_error_classes>;
/// Codes the normals of a brick whose mesh is there. raw: takes or gives what is sent as it is.
template <class Coder, class Raw>
void code_normals(Coder& coder, const EntropyTables& tables, const NormalIndex& index, Raw& raw,
                  std::vector<PredictedNormal>& predicted, LatticeBrick& brick) {
    predict_normals(brick, predicted);
    const Octahedron octahedron(brick.normal_bits);
    const int radius = octahedron.radius();
    const int turn = 2 * radius + 1;
    const int dropped = std::max(0, brick.normal_bits - most_coded_normal_bits);
    const auto error_class = [dropped](int error) {
        error >>= dropped;
        return error < 1 ? 0 : error < 2 ? 1 : error < 4 ? 2 : error < 7 ? 3 : error < 12 ? 4 : error < 20 ? 5 : 6;
    };
    if constexpr (!Coder::encodes) brick.normals.resize(brick.positions.size());
    coder.reserve(2 * brick.positions.size());
    std::array<int, 2> before{4 << dropped, 4 << dropped};
    for (std::size_t v = 0; v < brick.positions.size(); ++v) {
        const PredictedNormal& p = predicted[v];
        float largest = 0.0F;
        for (const float k : p.sum) largest = std::max(largest, std::abs(k));
        // The scale does not matter, but to a rounding that knows a smallest size.
        std::array<float, 3> scaled{1.0F, 0.0F, 0.0F};
        if (largest > 0.0F && std::isfinite(largest))
            for (std::size_t k = 0; k < 3; ++k) scaled[k] = p.sum[k] / largest;
        const Octahedron::Point middle = octahedron.point(scaled);
        const UnfoldedOctahedron unfolded(radius, middle);
        const std::array<int, 2> expected = unfolded.place(middle);
        const float flatness =
            p.magnitudes > 0.0F ? (std::abs(p.sum[0]) + std::abs(p.sum[1]) + std::abs(p.sum[2])) / p.magnitudes : 0.0F;
        const int flat = flatness > 0.995F   ? 0
                         : flatness > 0.985F ? 1
                         : flatness > 0.96F  ? 2
                         : flatness > 0.9F   ? 3
                         : flatness > 0.8F   ? 4
                                             : 5;
        std::array<int, 2> place{};
        if constexpr (Coder::encodes) place = unfolded.place(octahedron.point_of(brick.normals[v]));
        int error = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const int near = i == 0 ? error_class((before[0] + before[1]) / 2)
                                    : error_class((2 * error + (before[0] + before[1]) / 2) / 2);
            const int context = (static_cast<int>(i) * flatness_classes + flat) * normal_error_classes + near;
            int residual = 0;
            if constexpr (Coder::encodes) {
                residual = place[i] - expected[i];
                if (residual > radius) residual -= turn;
                if (residual < -radius) residual += turn;
            }
            const int low = residual & ((1 << dropped) - 1);
            const int high = residual >> dropped;
            // The outermost symbols stand for all that is farther.
            const int symbol = coder.code(tables.normals, index, context,
                                          std::clamp(high, -largest_residual, largest_residual) + largest_residual) -
                               largest_residual;
            int found = symbol;
            if (std::abs(symbol) == largest_residual) {
                const int more = raw(static_cast<std::uint32_t>(std::abs(high) - largest_residual), brick.normal_bits);
                found = symbol < 0 ? symbol - more : symbol + more;
            }
            residual = found * (1 << dropped) + (dropped == 0 ? 0 : raw(static_cast<std::uint32_t>(low), dropped));
            if constexpr (!Coder::encodes) {
                int at = expected[i] + residual;
                if (at > radius) at -= turn;
                if (at < -radius) at += turn;
                place[i] = std::clamp(at, -radius, radius);
            }
            error += std::abs(residual);
        }
        before[1] = before[0];
        before[0] = error;
        if constexpr (!Coder::encodes) brick.normals[v] = octahedron.code(unfolded.point(place));
    }
}

}  // namespace meniscus
