#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/containers/face_index.hpp"
#include "formats/containers/ply.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "meniscus/names.hpp"

namespace meniscus::formats {
namespace {

/// Appends a polygon, given by indices into the positions, as a fan of triangles of one level.
void append_polygon(TriangleMesh& mesh, const std::vector<std::uint32_t>& corners, ReadBudget& budget,
                    const ByteCursor& at) {
    constexpr std::size_t bytes_each = sizeof(Triangle) + 1;  // with its level
    if (corners.size() > 2) budget.take(bytes_each * (corners.size() - 2), at, "the triangles");
    for (std::size_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

/// The digits that a number is written with, without zeros before the first.
int significant_digits(std::string_view number) {
    int count = 0;
    for (const char c : number.substr(0, number.find_first_of("eE")))
        if (c >= '0' && c <= '9' && (count > 0 || c != '0')) ++count;
    return count;
}

/// Keywords of OBJ that say nothing about triangles: comments, textures, names, materials, lines and points.
bool is_ignored(std::string_view keyword) {
    static constexpr std::array ignored{"vt", "vp", "o", "s", "l", "p", "usemtl", "mtllib"};
    return keyword.front() == '#' || std::find(ignored.begin(), ignored.end(), keyword) != ignored.end();
}

}  // namespace

TriangleMesh read_mesh_ply(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    PlyReader ply(name, bytes, limits);
    TriangleMesh mesh;
    bool has_vertices = false;
    for (const PlyElement& element : ply.elements()) {
        if (element.name == "vertex" && !has_vertices) {
            has_vertices = true;
            const std::array axes{element.scalar("x"), element.scalar("y"), element.scalar("z")};
            const std::array normal{element.scalar("nx"), element.scalar("ny"), element.scalar("nz")};
            if (!axes[0] || !axes[1] || !axes[2]) ply.in().fail("its vertices have no scalar properties x, y and z");
            const bool normals = normal[0] && normal[1] && normal[2];
            mesh.wide = std::any_of(axes.begin(), axes.end(), [&](const auto& axis) {
                return element.properties[*axis].type == ScalarType::float64;
            });
            expect_addressable(element.count, ply.in());
            ply.expect_rows(element);
            constexpr std::size_t place_bytes = sizeof(mesh.positions[0]) + sizeof(Normal);
            ply.budget().take((place_bytes + element.properties.size() * sizeof(float)) * element.count, ply.in(),
                              "its vertices");
            ArrayCollector collector(ply.in());
            std::vector<std::pair<std::size_t, ArrayBuilder>> arrays;  // by property
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                const bool known = std::find(axes.begin(), axes.end(), p) != axes.end() ||
                                   (normals && std::find(normal.begin(), normal.end(), p) != normal.end());
                if (!known && !property.list_count_type)
                    arrays.emplace_back(p, ArrayBuilder(property.name, property.type, 1, element.count));
            }
            mesh.positions.reserve(element.count);
            if (normals) mesh.normals.reserve(element.count);
            ply.read_rows(element, [&](std::size_t, const PlyRow& row) {
                mesh.positions.push_back({row.scalars[*axes[0]], row.scalars[*axes[1]], row.scalars[*axes[2]]});
                if (normals)
                    mesh.normals.push_back({static_cast<float>(row.scalars[*normal[0]]),
                                            static_cast<float>(row.scalars[*normal[1]]),
                                            static_cast<float>(row.scalars[*normal[2]])});
                for (auto& [p, array] : arrays) array.add(row.scalars[p]);
            });
            for (auto& [p, array] : arrays) collector.add(std::move(array));
            std::vector<std::string> left_out;
            collector.finish(mesh.attributes, left_out);
        } else if (element.name == "face") {
            const auto list =
                element.list("vertex_indices") ? element.list("vertex_indices") : element.list("vertex_index");
            const auto level = element.scalar("level");
            if (!list) ply.in().fail("its faces have no list vertex_indices");
            if (!has_vertices) ply.in().fail("its faces come before its vertices");
            std::vector<std::uint32_t> corners;
            ply.read_rows(element, [&](std::size_t, const PlyRow& row) {
                corners.clear();
                for (const double v : row.lists[*list]) corners.push_back(to_index(v, mesh.positions.size(), ply.in()));
                append_polygon(mesh, corners, ply.budget(), ply.in());
                if (!level) return;
                const double l = row.scalars[*level];
                mesh.levels.resize(mesh.triangles.size(),
                                   l >= 1.0 && l <= 3.0 ? static_cast<std::uint8_t>(l) : std::uint8_t{0});
            });
        } else {
            ply.read_rows(element, [](std::size_t, const PlyRow&) {});
        }
    }
    if (!has_vertices) ply.in().fail("a PLY file without vertices");
    ply.expect_end();
    return mesh;
}

/// The byte of the level that write_obj() names a group by; -1 for other groups.
int level_of_group(std::string_view group) {
    const auto level = find_by_name<TriangleLevel>(group);
    return level ? level_byte(*level) : -1;
}

TriangleMesh read_obj(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    ByteCursor in(name, bytes);
    ReadBudget budget(limits, bytes.size(), in);
    TriangleMesh mesh;
    std::vector<Normal> normals;
    std::vector<std::uint32_t> corners;
    int level = -1;  // none named yet
    while (in.remaining() > 0) {
        ByteCursor words(name, in.line());
        if (!words.skip_space()) continue;
        const std::string_view keyword = words.word();
        if (keyword == "v") {
            budget.take(sizeof(mesh.positions[0]), in, "its vertices");
            auto& position = mesh.positions.emplace_back();
            for (double& x : position) {
                const std::string_view text = words.word();
                x = to_number(text, words, "coordinate");
                mesh.wide = mesh.wide || significant_digits(text) > std::numeric_limits<float>::max_digits10;
            }
        } else if (keyword == "vn") {
            budget.take(sizeof(Normal), in, "its normals");
            normals.push_back({static_cast<float>(words.number("nx")), static_cast<float>(words.number("ny")),
                               static_cast<float>(words.number("nz"))});
        } else if (keyword == "g") {
            const std::string_view group = words.skip_space() ? words.word() : std::string_view{};
            level = level_of_group(group);
        } else if (keyword == "f") {
            corners.clear();
            while (words.skip_space()) {
                const std::string_view corner = words.word();
                double index = to_number(corner.substr(0, corner.find('/')), in, "vertex of a face");
                // Negative ones count from the end.
                index = index < 0.0 ? index + static_cast<double>(mesh.positions.size()) : index - 1.0;
                if (corners.size() == corners.capacity())
                    budget.take(sizeof(corners[0]) * (corners.size() + 1), in, "the corners of a face");
                corners.push_back(to_index(index, mesh.positions.size(), in));
            }
            append_polygon(mesh, corners, budget, in);
            if (level >= 0) mesh.levels.resize(mesh.triangles.size(), static_cast<std::uint8_t>(level));
        } else if (!is_ignored(keyword)) {
            in.fail(quoted(keyword) + " is no keyword of an OBJ file");
        }
    }
    expect_addressable(mesh.positions.size(), in);
    // Normals are used if they are one per vertex, as Meniscus writes them.
    if (normals.size() == mesh.positions.size()) mesh.normals = std::move(normals);
    if (mesh.levels.size() != mesh.triangles.size()) mesh.levels.clear();
    return mesh;
}

}  // namespace meniscus::formats
