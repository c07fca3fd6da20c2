// Memory is counted, limited, and kept between frames.
#include <gtest/gtest.h>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

TEST(Memory, AWarmFrameOfTheSameSizeAllocatesNothing) {
    for (const Mode mode : {Mode::adaptive, Mode::uniform})
        for (const EdgePoints& edge_points : choices<EdgePoints>) {
            Settings settings = test::default_settings();
            settings.mode = mode;
            settings.edge_points = edge_points;
            Reconstructor reconstructor(settings, {Backend::cpu, 2, 0});
            Mesh meshes[2];
            const test::Particles particles = test::splash(41);
            for (Mesh& mesh : meshes) reconstructor.reconstruct(particles.frame(), mesh);
            EXPECT_GT(reconstructor.statistics().allocations, 0U);
            for (int frame = 0; frame < 6; ++frame) {
                reconstructor.reconstruct(particles.frame(), meshes[frame % 2]);
                EXPECT_EQ(reconstructor.statistics().allocations, 0U) << "frame " << frame;
            }
        }
}

TEST(Memory, AFramePastTheLimitIsRefusedAndASmallerOneThenWorks) {
    const Settings settings = test::default_settings();
    Mesh mesh;
    const test::Particles small = test::splash(42, 6);
    const test::Particles large = test::splash(42, 30);
    std::string expected;
    std::size_t peak = 0;
    {
        Reconstructor unlimited(settings, {Backend::cpu, 1, 0});
        unlimited.reconstruct(small.frame(), mesh);
        expected = mesh_sha256(mesh);
        peak = unlimited.statistics().peak_bytes;
    }
    Reconstructor limited(settings, {Backend::cpu, 1, 3 * peak});
    try {
        limited.reconstruct(large.frame(), mesh);
        FAIL() << "a frame beyond the limit was accepted";
    } catch (const LimitExceeded& e) {
        EXPECT_NE(std::string(e.what()).find(std::to_string(3 * peak)), std::string::npos) << e.what();
    }
    EXPECT_TRUE(mesh.triangles.empty());
    limited.reconstruct(small.frame(), mesh);
    EXPECT_EQ(mesh_sha256(mesh), expected);
    EXPECT_LE(limited.statistics().peak_bytes, 3 * peak);
}

TEST(Memory, OfTheLastFrameGoesWhileItsMeshIsMade) {
    Settings settings = test::default_settings();
    const test::Particles particles = test::splash(43, 20);
    for (const Mode mode : {Mode::adaptive, Mode::uniform})
        for (const Field field : choices<Field>) {
            settings.mode = mode;
            settings.field = field;
            const auto memory = std::make_shared<SharedMemory>();
            const BackendOptions options{.backend = Backend::cpu, .threads = 1, .shared_memory = memory};
            Mesh mesh, last;
            Reconstructor kept(settings, options);
            kept.reconstruct(particles.frame(), mesh);
            EXPECT_NO_THROW(kept.emit_capped(1, last));

            Reconstructor released(settings, options);
            last = {};
            const std::size_t before = memory->bytes();
            released.reconstruct_last(particles.frame(), last);
            EXPECT_EQ(mesh_sha256(last), mesh_sha256(mesh));
            EXPECT_EQ(released.statistics().volume, kept.statistics().volume);
            EXPECT_EQ(released.statistics().base_cells_by_level, kept.statistics().base_cells_by_level);
            EXPECT_LT(released.statistics().peak_bytes, kept.statistics().peak_bytes);
            const std::size_t of_mesh =
                last.vertices.capacity() * sizeof(LatticePosition) + last.normals.capacity() * sizeof(Normal) +
                last.triangles.capacity() * sizeof(Triangle) + last.bricks.capacity() * sizeof(MeshBrick);
            EXPECT_EQ(memory->bytes() - before, of_mesh) << "nothing is left but the mesh";
            EXPECT_THROW(released.emit_capped(1, last), InvalidInput);

            released.reconstruct(particles.frame(), last);
            EXPECT_EQ(mesh_sha256(last), mesh_sha256(mesh)) << "the next frame takes its memory again";
        }
}

TEST(Memory, OfTheLastFrameIsThereToTellWhyItsSurfaceIsEmpty) {
    Settings settings = test::default_settings();
    settings.field = Field::color;  // the smooth field is lifted above any threshold
    settings.iso = 3.0;
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    reconstructor.reconstruct(test::splash(44, 6).frame(), mesh);
    const std::vector<Warning> expected = reconstructor.statistics().warnings;
    ASSERT_FALSE(expected.empty());
    reconstructor.reconstruct_last(test::splash(44, 6).frame(), mesh);
    EXPECT_EQ(reconstructor.statistics().warnings, expected);
}

TEST(Memory, FollowsTheFluidAndNotItsExtent) {
    Reconstructor near(test::default_settings(), {Backend::cpu, 1, 0});
    Reconstructor apart(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh;
    test::Particles together, spread;
    for (int i = 0; i < 64; ++i) {
        together.add(static_cast<float>(i) * 0.4F, 0.0F, 0.0F);
        spread.add(static_cast<float>(i) * 400.0F, static_cast<float>(i % 8) * 300.0F, 0.0F);
    }
    near.reconstruct(together.frame(), mesh);
    apart.reconstruct(spread.frame(), mesh);
    EXPECT_LT(apart.statistics().peak_bytes, 3 * near.statistics().peak_bytes);
}

TEST(Memory, LimitedAnewIsThatOfTheNextFrames) {
    Reconstructor reconstructor(test::default_settings(), {.backend = Backend::cpu, .threads = 1});
    const test::Particles particles = test::splash(42, 20);
    Mesh mesh;
    reconstructor.reconstruct(particles.frame(), mesh);
    const std::string hash = mesh_sha256(mesh);
    reconstructor.limit_memory(1);
    reconstructor.reconstruct(particles.frame(), mesh);
    EXPECT_EQ(mesh_sha256(mesh), hash) << "the buffers are there";
    reconstructor.release_memory();
    EXPECT_THROW(reconstructor.reconstruct(particles.frame(), mesh), MemoryLimitExceeded);
    reconstructor.limit_memory(0);
    reconstructor.reconstruct(particles.frame(), mesh);
    EXPECT_EQ(mesh_sha256(mesh), hash);
}

TEST(Memory, OfAllReconstructorsHasALimitOfItsOwn) {
    const Settings settings = test::default_settings();
    const test::Particles particles = test::splash(42, 20);
    const auto reconstructor = [&](const std::shared_ptr<SharedMemory>& memory) {
        return Reconstructor(settings, {.backend = Backend::cpu, .threads = 1, .shared_memory = memory});
    };
    Mesh meshes[2];
    const auto counted = std::make_shared<SharedMemory>();
    std::size_t bytes = 0;
    {
        Reconstructor alone = reconstructor(counted);
        alone.reconstruct(particles.frame(), meshes[0]);
        bytes = counted->bytes();
    }
    EXPECT_GT(counted->bytes(), 0U) << "a mesh outlives its reconstructor";
    meshes[0] = {};
    EXPECT_EQ(counted->bytes(), 0U);

    Reconstructor* idle = nullptr;
    const auto memory = std::make_shared<SharedMemory>(bytes + bytes / 2, [&](std::size_t missing) {
        EXPECT_GT(missing, 0U);
        if (idle != nullptr) idle->release_memory();
    });
    Reconstructor first = reconstructor(memory);
    Reconstructor second = reconstructor(memory);
    first.reconstruct(particles.frame(), meshes[0]);
    EXPECT_THROW(second.reconstruct(particles.frame(), meshes[1]), LimitExceeded);
    EXPECT_LE(memory->bytes(), memory->limit());
    idle = &first;
    second.reconstruct(particles.frame(), meshes[1]);
    EXPECT_LE(memory->bytes(), memory->limit());
    EXPECT_EQ(mesh_sha256(meshes[1]), mesh_sha256(meshes[0]));
    idle = &second;
    first.reconstruct(particles.frame(), meshes[0]);
    EXPECT_EQ(mesh_sha256(meshes[1]), mesh_sha256(meshes[0]));
}

}  // namespace
}  // namespace meniscus
