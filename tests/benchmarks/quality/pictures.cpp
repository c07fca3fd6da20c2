#include "quality/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/bytes/atomic_file.hpp"
#include "picture/picture.hpp"
#include "quality/triangle.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using Box = std::array<Point, 2>;

constexpr std::size_t width = 900;
constexpr std::size_t height = 600;
/// The part that is drawn from near: of the frame's extent in x and z, and radii above its bottom.
constexpr std::array<double, 2> near_x{0.0, 0.45};
constexpr std::array<double, 2> near_z{0.55, 1.0};
constexpr double near_height = 45.0;
constexpr double beyond_particles = 3.0;  ///< radii that a surface may stand out

Box bounds_of(const std::vector<Point>& places) {
    Box box{places.at(0), places.at(0)};
    for (const Point& p : places)
        for (std::size_t a = 0; a < 3; ++a) {
            box[0][a] = std::min(box[0][a], p[a]);
            box[1][a] = std::max(box[1][a], p[a]);
        }
    return box;
}

Box near_part(const Box& box) {
    const auto part_of = [&](std::size_t axis, const std::array<double, 2>& part) {
        const double extent = box[1][axis] - box[0][axis];
        return std::array<double, 2>{box[0][axis] + part[0] * extent, box[0][axis] + part[1] * extent};
    };
    const auto [low_x, high_x] = part_of(0, near_x);
    const auto [low_z, high_z] = part_of(2, near_z);
    return {{{low_x, box[0][1], low_z}, {high_x, std::min(box[0][1] + near_height, box[1][1]), high_z}}};
}

bool contains(const Box& box, const Point& p, double margin) {
    for (std::size_t a = 0; a < 3; ++a)
        if (p[a] < box[0][a] - margin || p[a] > box[1][a] + margin) return false;
    return true;
}

/// The back of the surface, which shows only where a cut opens it.
bool faces_away(const Corners& corners, const cli::PictureOptions& options) {
    const double azimuth = options.azimuth * std::numbers::pi / 180.0;
    const double elevation = options.elevation * std::numbers::pi / 180.0;
    const Point viewer{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                       std::cos(azimuth) * std::cos(elevation)};
    const Point normal = area_normal(corners);
    constexpr double perspective = 0.3;  // rays are not parallel
    return compare::dot(normal, viewer) < -perspective * length_of(normal);
}

/// The camera takes in all positions: those of the box alone, which are the same for every surface.
formats::TriangleMesh cut(const Surface& surface, const Box& box, const cli::PictureOptions& options) {
    formats::TriangleMesh mesh;
    std::vector<std::uint32_t> numbers(surface.positions.size());
    std::vector<bool> kept(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        kept[i] = contains(box, surface.positions[i], beyond_particles);
        if (!kept[i]) continue;
        numbers[i] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(surface.positions[i]);
        if (!surface.normals.empty()) mesh.normals.push_back(surface.normals[i]);
    }
    for (const Triangle& t : surface.triangles)
        if (kept[t[0]] && kept[t[1]] && kept[t[2]] && !faces_away(surface.view().corners(t), options))
            mesh.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point p{};
        for (std::size_t a = 0; a < 3; ++a) {
            const bool is_high = (corner >> a & 1U) != 0;
            p[a] = is_high ? box[1][a] + beyond_particles : box[0][a] - beyond_particles;
        }
        mesh.positions.push_back(p);
        if (!mesh.normals.empty()) mesh.normals.push_back({});
    }
    return mesh;
}

}  // namespace

void draw_surface(const Surface& surface, const Cloud& cloud, const Method& method, double radius,
                  const std::filesystem::path& folder) {
    const Box whole = bounds_of(places_of(cloud, radius));
    cli::PictureOptions options;
    options.width = width;
    options.height = height;
    std::string name = cloud.name + "-" + method.field + "-" + method.mode;
    std::replace(name.begin(), name.end(), ' ', '-');
    formats::make_directory(folder);
    formats::write_png(folder / (name + ".png"), cli::draw_picture(cut(surface, whole, options), options));
    formats::write_png(folder / (name + "-near.png"),
                       cli::draw_picture(cut(surface, near_part(whole), options), options));
}

}  // namespace meniscus::benchmarks::quality
