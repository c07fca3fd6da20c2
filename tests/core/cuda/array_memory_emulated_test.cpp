// Where the arrays of a reconstruction lie on the device: the mesh does not depend on it, and what is written beside an
// array is noticed where they lie between guards.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/state.hpp"
#include "meniscus/meniscus.hpp"
#include "pipeline/backend.hpp"
#include "support/environment.hpp"
#include "support/particles.hpp"
#include "support/same_bytes.hpp"

namespace meniscus {
namespace {

constexpr const char* variable = "MENISCUS_DEVICE_ARRAYS";

/// The arrays of a state with room for some particles.
struct Arrays {
    explicit Arrays(const char* placement) : chosen(variable, placement) {
        state.capacity.grow_to(1000, {});
        memory.assign(state.arrays());
        stream.synchronize();
    }

    test::EnvironmentVariable chosen;
    cuda::Stream stream;
    cuda::State state{LatticeSettings(test::default_settings())};
    std::shared_ptr<MemoryAccount> account = std::make_shared<MemoryAccount>();
    cuda::ArrayMemory memory{0, stream.get(), account};
};

TEST(ArrayMemoryEmulated, AnOverrunAndAnUnderrunAreFoundBetweenGuards) {
    Arrays arrays("guarded");
    cuda::State& state = arrays.state;
    EXPECT_NO_THROW(arrays.memory.require_whole_guards(state.arrays()));
    const auto refusal = [&]() -> std::string {
        try {
            arrays.memory.require_whole_guards(state.arrays());
        } catch (const DeviceError& error) {
            return error.what();
        }
        return {};
    };
    auto* const after = reinterpret_cast<std::byte*>(state.first_particle + state.capacity.particles + 1);
    const std::byte guard = after[3];
    after[3] = std::byte{1};
    EXPECT_NE(refusal().find("the array first_particle of 4504 bytes was overrun 3 bytes after its end"),
              std::string::npos)
        << refusal();
    after[3] = guard;
    reinterpret_cast<std::byte*>(state.samples)[-1] = std::byte{1};
    EXPECT_NE(refusal().find("the array samples of "), std::string::npos) << refusal();
    EXPECT_NE(refusal().find("1 bytes before its begin"), std::string::npos) << refusal();
}

TEST(ArrayMemoryEmulated, PoisonReachesEveryArrayButTheTables) {
    Arrays arrays("guarded");
    cuda::State& state = arrays.state;
    state.upload_tables(arrays.stream.get());
    arrays.memory.poison(state.arrays());
    EXPECT_EQ(state.level[0], 0xFF);
    EXPECT_NE(state.samples[0], state.samples[0]) << "not a number";
    EXPECT_EQ(std::memcmp(state.cube_table, cube_table.data(), sizeof(CubeTable)), 0);
    arrays.memory.poison(state.arrays());
    EXPECT_NE(state.level[0], 0xFF) << "a word that is left alone must not be the same in every frame";
    EXPECT_NO_THROW(arrays.memory.require_whole_guards(state.arrays()));
}

TEST(ArrayMemoryEmulated, ArraysAreChargedAsOneAllocation) {
    for (const char* const placement : {"together", "guarded", "separate"}) {
        SCOPED_TRACE(placement);
        Arrays arrays(placement);
        EXPECT_EQ(arrays.account->allocations(), 1U);
        EXPECT_EQ(arrays.account->bytes(), arrays.memory.bytes_for(arrays.state.arrays()));
        arrays.memory.release();
        EXPECT_EQ(arrays.account->bytes(), 0U);
    }
}

TEST(ArrayMemoryEmulated, TheMeshDoesNotDependOnThePlacement) {
    const test::Particles particles = test::splash(3, 6);
    const Settings settings = test::default_settings();
    const Mesh expected = test::reconstruct(settings, particles.frame());
    for (const char* const placement : {"", "together", "guarded", "separate"}) {
        SCOPED_TRACE(placement);
        const test::EnvironmentVariable chosen(variable, placement);
        const auto backend = cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                                       std::make_shared<MemoryAccount>());
        for (int frame = 0; frame < 4; ++frame) {
            Mesh mesh;
            Statistics statistics;
            backend->reconstruct(particles.frame(), mesh, statistics).finish();
            EXPECT_TRUE(test::same_bytes(mesh.vertices, expected.vertices));
            EXPECT_TRUE(test::same_bytes(mesh.normals, expected.normals));
            EXPECT_TRUE(test::same_bytes(mesh.triangles, expected.triangles));
        }
    }
}

TEST(ArrayMemoryEmulated, APlacementThatIsNoneIsRefused) {
    const test::EnvironmentVariable chosen(variable, "guards");
    try {
        cuda::array_placement();
        ADD_FAILURE() << "not refused";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "MENISCUS_DEVICE_ARRAYS is \"guards\", must be together, guarded or separate; "
                     "leave the variable unset for the fastest");
    }
}

}  // namespace
}  // namespace meniscus
