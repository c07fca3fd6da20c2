// Random sequences of frames on the device in software, with and without levels and payload, crowded ones, capped
// emissions, downloads that wait and memory limits between: each mesh is the CPU's, after any frames before it.
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <optional>
#include <random>

#include "meniscus/error.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

/// Frames that repeat in a sequence, with the CPU's meshes of them.
struct Scene {
    test::Particles particles;
    Mesh meshes[4];  ///< meshes by cap of the levels, 1 to 3; 0: without a cap
};

std::vector<Scene> scenes_with_and_without_levels() {
    std::vector<test::Particles> frames(2);
    frames[1].add(0.1F, 0.2F, 0.3F);
    for (const int side : {3, 5, 4}) frames.push_back(test::splash(static_cast<unsigned>(side), side));
    for (std::size_t i = 1, n = frames.size(); i < n; ++i) {
        test::Particles leveled = frames[i];
        for (std::size_t p = 0; p < leveled.count(); ++p) leveled.levels.push_back(p % 5 == 0 ? 1 : 0);
        frames.push_back(leveled);
    }
    std::vector<Scene> scenes;
    for (test::Particles& particles : frames) {
        Scene& scene = scenes.emplace_back();
        scene.particles = std::move(particles);
        Reconstructor cpu(test::default_settings(), {Backend::cpu, 1, 0});
        cpu.reconstruct(scene.particles.frame(), scene.meshes[0]);
        for (int cap = 1; cap <= 3; ++cap) cpu.emit_capped(cap, scene.meshes[cap]);
    }
    return scenes;
}

/// Up to 16 arrays of elements of up to 40 bytes.
struct RandomPayload {
    std::deque<std::vector<std::byte>> bytes;
    std::vector<ParticleArray> arrays;

    RandomPayload(std::mt19937& random, std::size_t particles) {
        const std::size_t count = random() % 4 == 0 ? max_particle_arrays : 1 + random() % 3;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t element_bytes = 1 + random() % 40;
            auto& data = bytes.emplace_back(particles * element_bytes);
            for (std::byte& b : data) b = static_cast<std::byte>(random() % 3);
            arrays.push_back({"array", data, ElementType::uint8, element_bytes});
        }
    }
};

class Sequence {
public:
    Sequence(unsigned seed, std::size_t device_limit) : random_(seed), device_limit_(device_limit) { begin(); }

    void run(const std::vector<Scene>& scenes, int frames) {
        for (int i = 0; i < frames; ++i) {
            SCOPED_TRACE(testing::Message() << "frame " << i);
            if (random_() % 12 == 0) refuse_crowd();
            // Often the same frame again, so that there are graphs to be stale.
            if (i == 0 || random_() % 2 == 0) scene_ = random_() % scenes.size();
            reconstruct(scenes[scene_]);
            if (testing::Test::HasFailure()) return;
        }
        finish_downloads();
    }
    int refusals() const { return refusals_; }
    int meshes() const { return meshes_; }

private:
    struct Waiting {
        Mesh mesh;
        const Mesh* expected = nullptr;
        MeshDownload download;
    };

    void begin() {
        backend_.reset();
        account_ = std::make_shared<MemoryAccount>(device_limit_, "on the GPU");
        backend_ = cuda::make_reconstruction(test::default_settings(), BackendOptions{},
                                             std::make_shared<MemoryAccount>(), account_);
    }

    void reconstruct(const Scene& scene) {
        std::optional<RandomPayload> payload;
        ParticleFrame frame = scene.particles.frame();
        if (random_() % 3 == 0) frame.arrays = payload.emplace(random_, frame.count()).arrays;
        auto waiting = std::make_unique<Waiting>();
        waiting->expected = &scene.meshes[0];
        Statistics statistics;
        try {
            waiting->download = backend_->reconstruct(frame, waiting->mesh, statistics);
        } catch (const LimitExceeded&) {
            ++refusals_;
            begin();
            return;
        }
        waiting_.push_back(std::move(waiting));
        while (random_() % 3 != 0) {
            const auto cap = static_cast<int>(1 + random_() % 3);
            Mesh mesh;
            try {
                backend_->emit_capped(cap, mesh);
            } catch (const LimitExceeded&) {
                ++refusals_;
                begin();
                return;
            }
            expect_equal(mesh, scene.meshes[cap]);
        }
        if (random_() % 2 == 0) finish_downloads();
        if (random_() % 8 == 0 && !waiting_.empty()) waiting_.pop_front();
    }

    void refuse_crowd() {
        test::Particles crowd;
        for (int i = 0; i < 17'000; ++i) crowd.add(0.0F, 0.0F, 0.0F);
        Mesh mesh;
        Statistics statistics;
        ParticleFrame frame = crowd.frame();
        std::optional<RandomPayload> payload;
        if (random_() % 2 == 0) frame.arrays = payload.emplace(random_, frame.count()).arrays;
        EXPECT_THROW(static_cast<void>(backend_->reconstruct(frame, mesh, statistics)), LimitExceeded);
        // A reconstructor makes its backend anew. A backend that was refused memory cannot go on; after a crowd it can.
        if (device_limit_ != 0 || random_() % 2 == 0) begin();
    }

    void finish_downloads() {
        for (const auto& waiting : waiting_) {
            waiting->download.finish();
            expect_equal(waiting->mesh, *waiting->expected);
        }
        waiting_.clear();
    }

    void expect_equal(const Mesh& mesh, const Mesh& expected) {
        ++meshes_;
        EXPECT_EQ(mesh.vertices, expected.vertices);
        EXPECT_EQ(mesh.triangles, expected.triangles);
        EXPECT_EQ(mesh.bricks.size(), expected.bricks.size());
    }

    std::mt19937 random_;
    std::size_t device_limit_;
    std::shared_ptr<MemoryAccount> account_;
    std::unique_ptr<BackendReconstruction> backend_;
    std::size_t scene_ = 0;
    int refusals_ = 0;
    int meshes_ = 0;
    std::deque<std::unique_ptr<Waiting>> waiting_;
};

TEST(CudaSequencesEmulated, GiveTheCpusMeshesWhateverCameBefore) {
    const std::vector<Scene> scenes = scenes_with_and_without_levels();
    for (unsigned seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Sequence sequence(seed, 0);
        sequence.run(scenes, 25);
        EXPECT_EQ(sequence.refusals(), 0);
        EXPECT_GT(sequence.meshes(), 25);
    }
}

TEST(CudaSequencesEmulated, GiveTheCpusMeshesWhereMemoryIsShort) {
    const std::vector<Scene> scenes = scenes_with_and_without_levels();
    int refusals = 0;
    int meshes = 0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Sequence sequence(seed, 500'000 + seed * std::size_t{400'000});  // half a megabyte: guards around arrays
        sequence.run(scenes, 15);
        refusals += sequence.refusals();
        meshes += sequence.meshes();
    }
    EXPECT_GT(refusals, 0) << "no limit was met";
    EXPECT_GT(meshes, 30) << "nearly all was refused";
}

}  // namespace
}  // namespace meniscus
