// A difference of meshes is found wherever it is, and named by its first element.
#include "gpu/mesh_difference.hpp"

#include <gtest/gtest.h>

namespace meniscus::benchmarks {
namespace {

void fill(Mesh& mesh) {
    for (int i = 0; i < 5; ++i) {
        mesh.vertices.push_back({i, -i, 7});
        mesh.normals.push_back({0.0F, 1.0F, static_cast<float>(i)});
        mesh.spray.push_back({0.5F, 0.25F, 0.0F});
    }
    mesh.triangles.push_back({0, 1, 2});
    mesh.triangles.push_back({2, 3, 4});
    mesh.bricks.push_back({});
}

void expect(const Mesh& gpu, std::size_t count, const std::string& first) {
    Mesh cpu;
    fill(cpu);
    const MeshDifference difference = find_difference(cpu, gpu);
    EXPECT_EQ(difference.count, count);
    EXPECT_NE(difference.first.find(first), std::string::npos) << difference.first;
    EXPECT_EQ(difference.first.find(','), std::string::npos) << "it goes into a table";
}

TEST(MeshDifference, NamesTheFirstElementThatDiffers) {
    Mesh same;
    fill(same);
    expect(same, 0, "");
    Mesh mesh;
    fill(mesh);
    mesh.vertices[3] = {3, -3, 8};
    mesh.vertices[4] = {0, 0, 0};
    expect(mesh, 2, "vertices (5 on the CPU; 5 on the GPU): 2 differ; the first is 3: CPU 3 -3 7; GPU 3 -3 8");
}

TEST(MeshDifference, SeesEveryArray) {
    Mesh mesh;
    fill(mesh);
    mesh.normals[1][0] = -0.0F;  // equal as a number
    expect(mesh, 1, "normals");
    Mesh order;
    fill(order);
    std::swap(order.triangles[0], order.triangles[1]);
    expect(order, 2, "triangles");
    Mesh longer;
    fill(longer);
    longer.spray.push_back({});
    expect(longer, 1, "spray (5 on the CPU; 6 on the GPU): 1 differ; the first is 5: CPU has none; GPU 0 0 0");
    Mesh levels;
    fill(levels);
    levels.levels[2].count = 1;
    expect(levels, 1, "levels");
    Mesh bricks;
    fill(bricks);
    bricks.bricks[0].ranges[3].first = 9;
    expect(bricks, 1, "bricks");
}

}  // namespace
}  // namespace meniscus::benchmarks
