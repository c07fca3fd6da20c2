#include "support/golden_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "meniscus/mesh_hash.hpp"
#include "meniscus/sha256.hpp"
#include "support/golden_scenes.hpp"

namespace meniscus::test {
namespace {

class Fnv1a {
public:
    template <class T>
    void add(const Array<T>& values) {
        add(values.data(), values.size() * sizeof(T));
    }
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ bytes[i]) * 0x100000001B3U;
    }
    std::string hexadecimal() const {
        std::string text;
        for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[hash_ >> shift & 15];
        return text;
    }

private:
    std::uint64_t hash_ = 0xCBF29CE484222325U;
};

}  // namespace

Settings GoldenRow::settings() const {
    Settings s;
    s.particle_radius = golden_radius;
    if (field == Field::smooth)
        s.smoothness = static_cast<std::uint32_t>(smoothing);
    else
        s.smoothing_length = smoothing;
    s.cell_size = cell_size;
    s.iso = iso;
    s.field = field;
    s.mode = mode;
    if (count_threshold > 0)
        s.criterion = CountCriterion{count_threshold};
    else
        s.criterion = CurvatureCriterion{tolerance};
    if (bisection_steps > 0)
        s.edge_points = Bisection{bisection_steps};
    else
        s.edge_points = Interpolation{};
    s.normals = normals;
    s.domain.reset();
    if (cropped) s.domain = Box{{-0.28125, 0.015625, -0.09375}, {0.3125, 0.171875, 0.25}};
    return s;
}

std::vector<GoldenRow> golden_rows() {
    constexpr Field color = Field::color, density = Field::density, smooth = Field::smooth;
    constexpr Mode adaptive = Mode::adaptive, uniform = Mode::uniform;
    constexpr bool yes = true, no = false;
    return {
        // name, scene, field, mode, smoothing, cell size, iso, tolerance, count threshold, bisection steps,
        // normals, cropped, max level
        // clang-format off
        {"splash, color, adaptive", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, color, by count", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.0, 1, 0, yes, no, 3},
        {"splash, color, by count of 3", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.0, 3, 0, yes, no, 3},
        {"splash, color, uniform", "splash", color, uniform, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, color, adaptive, 2 bisections", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 2, yes, no, 3},
        {"splash, color, adaptive, 5 bisections", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 5, yes, no, 3},
        {"splash, color, by count, 5 bisections", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.0, 1, 5, yes, no, 3},
        {"splash, color, uniform, 7 bisections", "splash", color, uniform, 2.0, 0.5, 0.6, 0.15, 0, 7, yes, no, 3},
        {"splash, density, adaptive", "splash", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 0, yes, no, 3},
        {"splash, density, by count", "splash", density, adaptive, 2.0, 0.5, 0.2, 0.0, 1, 0, yes, no, 3},
        {"splash, density, uniform", "splash", density, uniform, 2.0, 0.5, 0.2, 0.15, 0, 0, yes, no, 3},
        {"splash, density, adaptive, 5 bisections", "splash", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 5, yes, no, 3},
        {"splash, density, uniform, 2 bisections", "splash", density, uniform, 2.0, 0.5, 0.2, 0.15, 0, 2, yes, no, 3},
        {"splash, color, tolerance 0.05", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.05, 0, 0, yes, no, 3},
        {"splash, color, tolerance 0.4", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.4, 0, 0, yes, no, 3},
        {"splash, color, iso 0.35", "splash", color, adaptive, 2.0, 0.5, 0.35, 0.15, 0, 0, yes, no, 3},
        {"splash, color, no normals", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, no, no, 3},
        {"splash, color, cropped", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, yes, 3},
        {"splash, color, uniform, cropped", "splash", color, uniform, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, yes, 3},
        {"splash, density, cropped, 3 bisections", "splash", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 3, yes, yes, 3},
        {"splash, color, levels up to 2", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 2},
        {"splash, color, levels up to 1", "splash", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 1},
        {"splash, density, 5 bisections, levels up to 2", "splash", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 5, yes, no, 2},
        {"splash, color, uniform, levels up to 1", "splash", color, uniform, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 1},
        {"splash, color, cells of 0.3", "splash", color, adaptive, 2.0, 0.3, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, color, cells of 1", "splash", color, adaptive, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, density, cells of 1.37", "splash", density, adaptive, 2.0, 1.37, 0.2, 0.15, 0, 0, yes, no, 3},
        {"splash, color, cells of 1, smoothing 1.1", "splash", color, adaptive, 1.1, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, density, cells of 0.7, smoothing 1.3", "splash", density, adaptive, 1.3, 0.7, 0.3, 0.15, 0, 0, yes, no, 3},
        {"splash, color, cells of 0.7, smoothing 2.6", "splash", color, adaptive, 2.6, 0.7, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, density, by count of 2, smoothing 2.6", "splash", density, adaptive, 2.6, 1.0, 0.2, 0.0, 2, 0, yes, no, 3},
        {"slab, color, adaptive", "slab", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"slab, density, adaptive", "slab", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 0, yes, no, 3},
        {"slab, color, uniform", "slab", color, uniform, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"slab, color, by count", "slab", color, adaptive, 2.0, 0.5, 0.6, 0.0, 1, 0, yes, no, 3},
        {"slab, color, cropped", "slab", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, yes, 3},
        {"slab, color, levels up to 2", "slab", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 2},
        {"slab, color, levels up to 1", "slab", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 1},
        {"drops, color, adaptive", "drops", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"drops, density, adaptive, 5 bisections", "drops", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 5, yes, no, 3},
        {"drops, color, uniform", "drops", color, uniform, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"drops, density, by count, levels up to 2", "drops", density, adaptive, 2.0, 0.5, 0.2, 0.0, 1, 0, yes, no, 2},
        {"lone, color, adaptive", "lone", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"lone, density, adaptive", "lone", density, adaptive, 2.0, 0.5, 0.2, 0.15, 0, 0, yes, no, 3},
        {"lone, color, uniform, 4 bisections", "lone", color, uniform, 2.0, 0.5, 0.6, 0.15, 0, 4, yes, no, 3},
        {"lone, color, by count", "lone", color, adaptive, 2.0, 0.5, 0.6, 0.0, 1, 0, yes, no, 3},
        {"levels, color, adaptive", "levels", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"levels, density, adaptive", "levels", density, adaptive, 2.0, 1.0, 0.2, 0.15, 0, 0, yes, no, 3},
        {"levels, color, uniform", "levels", color, uniform, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"levels, color, by count", "levels", color, adaptive, 2.0, 1.0, 0.6, 0.0, 1, 0, yes, no, 3},
        {"levels, density, by count of 2, 3 bisections", "levels", density, adaptive, 2.0, 1.0, 0.2, 0.0, 2, 3, yes, no, 3},
        {"levels, color, cropped", "levels", color, adaptive, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, yes, 3},
        {"levels, color, levels up to 2", "levels", color, adaptive, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 2},
        {"levels, color, levels up to 1", "levels", color, adaptive, 2.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 1},
        {"quantized, color, adaptive", "quantized", color, adaptive, 2.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"quantized, density, uniform", "quantized", density, uniform, 2.0, 1.0, 0.2, 0.15, 0, 0, yes, no, 3},
        {"quantized, density, by count, cropped", "quantized", density, adaptive, 2.0, 0.5, 0.2, 0.0, 1, 0, yes, yes, 3},
        {"splash, smooth 5, adaptive", "splash", smooth, adaptive, 5.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, smooth 6, adaptive", "splash", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, smooth 7, uniform", "splash", smooth, uniform, 7.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"splash, smooth 6, cells of 1, levels up to 2", "splash", smooth, adaptive, 6.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 2},
        {"slab, smooth 6, adaptive", "slab", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"slab, smooth 6, cropped", "slab", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 0, yes, yes, 3},
        {"slab, smooth 5, by count", "slab", smooth, adaptive, 5.0, 1.0, 0.6, 0.0, 1, 0, yes, no, 3},
        {"drops, smooth 6, adaptive, 5 bisections", "drops", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 5, yes, no, 3},
        {"drops, smooth 7, adaptive", "drops", smooth, adaptive, 7.0, 1.0, 0.5, 0.15, 0, 0, yes, no, 3},
        {"lone, smooth 6, adaptive", "lone", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        {"lone, smooth 5, uniform", "lone", smooth, uniform, 5.0, 0.5, 0.6, 0.15, 0, 0, no, no, 3},
        {"levels, smooth 6, adaptive", "levels", smooth, adaptive, 6.0, 1.0, 0.6, 0.15, 0, 0, yes, no, 3},
        {"levels, smooth 7, levels up to 1", "levels", smooth, adaptive, 7.0, 1.37, 0.6, 0.15, 0, 0, yes, no, 1},
        {"quantized, smooth 6, adaptive", "quantized", smooth, adaptive, 6.0, 0.5, 0.6, 0.15, 0, 0, yes, no, 3},
        // clang-format on
    };
}

std::string golden_bytes(const Mesh& mesh) {
    static_assert(sizeof(MeshBrick) == 11 * sizeof(std::uint32_t), "padding has no value to hash");
    Fnv1a hash;
    hash.add(mesh.vertices);
    hash.add(mesh.normals);
    hash.add(mesh.triangles);
    hash.add(mesh.bricks);
    hash.add(mesh.levels.data(), sizeof mesh.levels);
    return hash.hexadecimal();
}

void expect_golden_meshes(const GoldenReconstruction& reconstruct) {
    std::map<std::string, GoldenScene> scenes;
    for (GoldenScene& scene : golden_scenes()) scenes.emplace(scene.name, std::move(scene));
    std::map<std::string_view, GoldenHashes> expected;
    for (const GoldenHashes& hashes : golden_hashes())
        EXPECT_TRUE(expected.emplace(hashes.row, hashes).second) << hashes.row << " has two lines";
    std::string bricks;
    for (const GoldenRow& row : golden_rows()) {
        const Mesh mesh = reconstruct(row, scenes.at(row.scene).frame());
        EXPECT_FALSE(mesh.triangles.empty()) << row.name;
        const std::string sha256 = mesh_sha256(mesh), bytes = golden_bytes(mesh);
        bricks += bricks_sha256(mesh);
        const auto found = expected.extract(row.name);
        if (!found || found.mapped().mesh_sha256 != sha256 || found.mapped().bytes != bytes)
            ADD_FAILURE() << "this mesh is not the golden one; its line would be\n        {\"" << row.name << "\", \""
                          << sha256 << "\", \"" << bytes << "\"},";
    }
    EXPECT_EQ(sha256_of(bricks), golden_bricks);
    for (const auto& entry : expected) ADD_FAILURE() << "no row is named \"" << entry.first << "\"";
}

}  // namespace meniscus::test
