#include "quality/pictures.hpp"

#include <algorithm>

#include "cli/picture.hpp"
#include "formats/atomic_file.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using Box = std::array<Point, 2>;

constexpr std::size_t width = 900;
constexpr std::size_t height = 600;
/// Of the frame's extent in x and z: what is drawn from near.
constexpr double near_begin = 0.3;
constexpr double near_end = 0.5;

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
    Box part = box;
    for (const std::size_t a : {std::size_t{0}, std::size_t{2}}) {
        const double extent = box[1][a] - box[0][a];
        part[0][a] = box[0][a] + near_begin * extent;
        part[1][a] = box[0][a] + near_end * extent;
    }
    return part;
}

bool contains(const Box& box, const Point& p, double margin) {
    for (std::size_t a = 0; a < 3; ++a)
        if (p[a] < box[0][a] - margin || p[a] > box[1][a] + margin) return false;
    return true;
}

/// The camera takes in all positions: those of the box alone, which are the same for every surface.
formats::TriangleMesh cut(const Surface& surface, const Box& box) {
    constexpr double beyond_particles = 3.0;  // radii that a surface may stand out
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
        if (kept[t[0]] && kept[t[1]] && kept[t[2]])
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
    formats::write_png(folder / (name + ".png"), cli::draw_picture(cut(surface, whole), options));
    formats::write_png(folder / (name + "-near.png"), cli::draw_picture(cut(surface, near_part(whole)), options));
}

}  // namespace meniscus::benchmarks::quality
