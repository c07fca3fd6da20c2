// The C interface in process: arrays of particles in, attributes of vertices out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include "in_process.hpp"

namespace meniscus::test {
namespace {

TEST(CAttributes, VerticesHaveWhatParticlesCarry) {
    const Particles particles = splash(7, 5);
    std::vector<float> velocities;
    std::vector<std::uint8_t> phases(particles.count(), 200);
    for (std::size_t i = 0; i < particles.count(); ++i)
        for (const float v : {0.5F, -2.0F, 1e-3F}) velocities.push_back(v);
    const meniscus_array arrays[] = {{"phase", MENISCUS_UINT8, 1, phases.data()},
                                     {"velocity", MENISCUS_FLOAT32, 3, velocities.data()}};
    meniscus_particles input = c_frame(particles);
    input.array_count = 2;
    input.arrays = arrays;
    const CMesh mesh = empty_mesh();
    const meniscus_array* attributes = arrays;
    std::size_t count = 7;
    const CReconstructor without = default_reconstructor();
    ASSERT_EQ(meniscus_reconstruct(without.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    ASSERT_EQ(meniscus_mesh_attributes(mesh.get(), &attributes, &count), MENISCUS_OK);
    EXPECT_EQ(count, 0U);
    EXPECT_EQ(attributes, nullptr);

    for (const auto& [names, expected] :
         {std::pair{"velocity phase", 2U}, std::pair{"all", 2U}, std::pair{"phase", 1U}}) {
        const CReconstructor reconstructor = reconstructor_of({{"particle-radius", "0.025"}, {"attribute", names}});
        ASSERT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK)
            << meniscus_error_message();
        ASSERT_EQ(meniscus_mesh_attributes(mesh.get(), &attributes, &count), MENISCUS_OK);
        ASSERT_EQ(count, expected) << names;
        const double* vertices = nullptr;
        std::size_t vertex_count = 0;
        ASSERT_EQ(meniscus_mesh_vertices(mesh.get(), &vertices, &vertex_count), MENISCUS_OK);
        ASSERT_GT(vertex_count, 0U);
        for (const meniscus_array& attribute : std::span(attributes, count)) {
            const bool velocity = std::string(attribute.name) == "velocity";
            EXPECT_EQ(attribute.type, velocity ? MENISCUS_FLOAT32 : MENISCUS_UINT8);
            ASSERT_EQ(attribute.components, velocity ? 3U : 1U);
            for (std::size_t i = 0; i < vertex_count; ++i)
                if (velocity)
                    ASSERT_EQ(static_cast<const float*>(attribute.data)[3 * i + 1], -2.0F);
                else
                    ASSERT_EQ(static_cast<const std::uint8_t*>(attribute.data)[i], 200);
        }
    }
}

TEST(CAttributes, RefusesWrongArraysByPlaceAndGoesOn) {
    const Particles particles = splash(7, 4);
    std::vector<float> ages(particles.count(), 1.0F);
    const CReconstructor reconstructor = reconstructor_of({{"particle-radius", "0.025"}, {"attribute", "age"}});
    const CMesh mesh = empty_mesh();
    const auto expect_refused = [&](meniscus_array array, const std::string& words) {
        meniscus_particles input = c_frame(particles);
        input.array_count = 1;
        input.arrays = &array;
        EXPECT_TRUE(
            refused(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_INVALID_INPUT, words));
    };
    expect_refused({nullptr, MENISCUS_FLOAT32, 1, ages.data()}, "particles->arrays[0].name is NULL");
    expect_refused({"", MENISCUS_FLOAT32, 1, ages.data()}, ".name has no characters");
    expect_refused({std::string(70, 'a').c_str(), MENISCUS_FLOAT32, 1, ages.data()}, ".name has more than 64");
    expect_refused({"age", 3, 1, ages.data()}, ".type is 3, must be MENISCUS_FLOAT32");
    expect_refused({"age", MENISCUS_FLOAT32, 0, ages.data()}, ".components are 0, must be 1 to 16");
    expect_refused({"age", MENISCUS_FLOAT32, 17, ages.data()}, ".components are 17");
    expect_refused({"age", MENISCUS_FLOAT32, 1, nullptr}, ".data is NULL");
    expect_refused({"speed", MENISCUS_FLOAT32, 1, ages.data()}, "age");
    meniscus_particles input = c_frame(particles);
    input.array_count = 1;
    EXPECT_TRUE(refused(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_INVALID_INPUT,
                        "particles->arrays is NULL, must point to 1 arrays"));
    input.array_count = 17;
    EXPECT_TRUE(refused(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_LIMIT_EXCEEDED,
                        "particles->array_count is 17, must be at most 16"));
    const meniscus_array good{"age", MENISCUS_FLOAT32, 1, ages.data()};
    input.array_count = 1;
    input.arrays = &good;
    EXPECT_EQ(meniscus_reconstruct(reconstructor.get(), &input, mesh.get()), MENISCUS_OK) << meniscus_error_message();
    EXPECT_NE(refusal_of({{"attribute", "all velocity"}}).find("must be names, or all alone"), std::string::npos);
    EXPECT_NE(refusal_of({{"attribute", "Velocity"}}).find("Velocity"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
