#include <algorithm>
#include <cmath>
#include <utility>

#include "picture/color_legend.hpp"
#include "picture/picture.hpp"
#include "picture/shading.hpp"
#include "picture/shown_values.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t samples_per_axis = 3;
/// Half the width of a line of the wireframe, pixels: each of an edge's two triangles draws its half.
constexpr float half_line = 0.6F;

using Direction = std::array<float, 3>;

Direction face_normal(const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vector3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Vector3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 0.0)) return {0.0F, 0.0F, 0.0F};
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

/// Weighted sum of the corners' normals, unit, turned towards the viewer.
Direction interpolate(const std::array<Direction, 3>& corners, const std::array<float, 3>& weights) {
    Direction n{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a) n[a] += weights[i] * corners[i][a];
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0.0F)) return {0.0F, 0.0F, 1.0F};
    const float sign = n[2] < 0.0F ? -1.0F : 1.0F;
    return {sign * n[0] / length, sign * n[1] / length, sign * n[2] / length};
}

/// What the surface is colored by.
class Coloring {
public:
    Coloring(const formats::TriangleMesh& mesh, const PictureOptions& options)
        : values_(values_to_show(mesh, options.color)), map_(options.color_map) {
        if (options.range)
            values_.range = options.range;
        else if (values_.range && is_diverging(map_))
            values_.range = around_zero(*values_.range);
    }

    /// sRGB, 0 to 255.
    std::array<float, 3> at(const Triangle& triangle, const std::array<float, 3>& weights) const {
        if (values_.colors.empty()) {
            float value = 0.0F;
            for (std::size_t k = 0; k < 3; ++k) value += weights[k] * values_.numbers[triangle[k]];
            const Rgb color = color_of(map_, part_of(static_cast<double>(value), *values_.range));
            return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
        }
        std::array<float, 3> mean{};
        const auto nearest = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c) {
                const float weight = !values_.nearest ? weights[k] : k == nearest ? 1.0F : 0.0F;
                mean[c] += weight * static_cast<float>(values_.colors[triangle[k]][c]);
            }
        return mean;
    }

    ColorLegend legend() const { return {values_.title, map_, values_.range}; }

private:
    ShownValues values_;
    ColorMap map_;
};

}  // namespace

formats::Image draw_picture(const formats::TriangleMesh& mesh, const PictureOptions& options) {
    std::optional<Coloring> coloring;
    if (!options.color.empty()) coloring.emplace(mesh, options);
    const std::size_t free_height = options.height - (coloring ? legend_height(options.height) : 0);
    const Camera camera(mesh.positions, options.up, options.azimuth, options.elevation, options.width, free_height);
    Rasterizer rasterizer(options.width, options.height, samples_per_axis);
    rasterizer.clear([&](float row) -> Color {
        if (options.wireframe) return {1.0F, 1.0F, 1.0F};
        return {0.93F - 0.18F * row, 0.95F - 0.15F * row, 0.98F - 0.12F * row};
    });
    const Direction up =
        camera.turn(options.up == UpAxis::y ? Direction{0.0F, 1.0F, 0.0F} : Direction{0.0F, 0.0F, 1.0F});
    std::vector<ScreenPoint> points;
    points.reserve(mesh.positions.size());
    for (const Vector3& p : mesh.positions) points.push_back(camera.project(p));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        std::array<Direction, 3> normals{};
        if (mesh.normals.empty())
            normals.fill(camera.turn(face_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]])));
        else
            for (std::size_t k = 0; k < 3; ++k) normals[k] = camera.turn(mesh.normals[t[k]]);
        const std::uint8_t level = mesh.levels.empty() ? std::uint8_t{1} : mesh.levels[i];
        rasterizer.draw({points[t[0]], points[t[1]], points[t[2]]}, [&](const Fragment& fragment) {
            const Direction n = interpolate(normals, fragment.weights);
            if (coloring) return colored(coloring->at(t, fragment.weights), n);
            if (!options.wireframe) return water(n, up);
            return wire(level, fragment.edge_distance < half_line ? 1.0F : 0.0F, n[2]);
        });
    }
    formats::Image image = rasterizer.image();
    if (coloring) draw_legend(image, coloring->legend());
    return image;
}

}  // namespace meniscus::cli
