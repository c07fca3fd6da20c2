// Parts that are reconstructed by themselves and compared at their seams give the mesh of the whole, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parts/brick_deal.hpp"
#include "support/parts.hpp"

namespace meniscus {
namespace {

/// Some three bricks a side for a splash of 16 particles a side.
Settings small_cells() {
    Settings settings = test::default_settings();
    settings.cell_size = 0.25;
    return settings;
}

TEST(Parts, GiveTheWholesMeshForAnyNumberOfThem) {
    const test::Particles particles = test::splash(41, 16);
    for (std::size_t parts = 1; parts <= 8; ++parts) {
        SCOPED_TRACE(parts);
        test::expect_the_whole(small_cells(), particles.frame(), {.parts = parts});
    }
    test::expect_the_whole(small_cells(), particles.frame(), {.parts = 27});
}

TEST(Parts, GiveTheWholesMeshForEverySetting) {
    const test::Particles particles = test::splash(43, 12);
    for (const Field field : choices<Field>)
        for (const Mode mode : choices<Mode>)
            for (const Criterion& criterion : choices<Criterion>)
                for (const EdgePoints& edge_points : choices<EdgePoints>) {
                    if (mode == Mode::uniform && criterion.index() != 0) continue;
                    Settings settings = small_cells();
                    settings.field = field;
                    settings.iso = field == Field::density ? 0.2 : 0.6;
                    settings.mode = mode;
                    settings.criterion = criterion;
                    settings.edge_points = edge_points;
                    settings.normals = edge_points.index() == 0;
                    SCOPED_TRACE(testing::Message() << name_of(field) << " " << name_of(mode) << " "
                                                    << criterion.index() << " " << edge_points.index());
                    test::expect_the_whole(settings, particles.frame(), {.parts = 4});
                }
}

TEST(Parts, GiveTheWholesMeshOfACroppedFrame) {
    Settings settings = small_cells();
    settings.domain = Box{{0.1, -0.05, 0.2}, {0.62, 0.55, 9.0}};
    test::expect_the_whole(settings, test::splash(44, 14).frame(), {.parts = 6});
}

TEST(Parts, GiveTheWholesMeshOfAdaptiveParticles) {
    test::Particles particles = test::splash(45, 12);
    for (std::size_t i = 0; i < particles.count(); ++i)
        particles.levels.push_back(particles.positions[3 * i] < 0.2F ? 1 : 0);
    for (const Field field : choices<Field>) {
        Settings settings = small_cells();
        settings.field = field;
        settings.iso = field == Field::density ? 0.2 : 0.6;
        test::expect_the_whole(settings, particles.frame(), {.parts = 5});
    }
}

TEST(Parts, GiveTheWholesSpray) {
    test::Particles particles = test::splash(46, 10);
    std::mt19937 random(46);
    std::uniform_real_distribution<float> place(-0.6F, 1.2F);
    for (int i = 0; i < 300; ++i) particles.add(place(random), place(random), place(random));
    for (const Spray spray : choices<Spray>) {
        Settings settings = small_cells();
        settings.spray = spray;
        test::expect_the_whole(settings, particles.frame(), {.parts = 7});
    }
}

// Extremes and huge values are found in other parts than those whose means they hold and scale.
TEST(Parts, GiveTheWholesAttributes) {
    test::ParticlesWithArrays particles = test::with_noise(test::splash(47, 14), 47);
    particles.add_floats("huge", 1, [](std::size_t i, std::size_t) { return i == 0 ? 0x1p100F : 0.1F; });
    particles.add_floats("constant", 3, [](std::size_t, std::size_t) { return 0.1F; });
    Settings settings = small_cells();
    settings.all_attributes = true;
    for (const std::size_t parts : {2U, 8U}) test::expect_the_whole(settings, particles.frame(), {.parts = parts});
}

TEST(Parts, GiveTheWholesMeshOfRareInputs) {
    for (const test::NamedParticles& input : test::adversarial(0.025F)) {
        SCOPED_TRACE(input.name);
        test::expect_the_whole(small_cells(), input.particles.frame(), {.parts = 4});
    }
}

// The cells of a film or of a drop that a cut divides decide about each other across it.
TEST(Parts, AreCutThroughDropsAndFilms) {
    const Settings settings = test::default_settings();
    const auto brick = static_cast<float>(brick_cells * world_cell_size(settings));
    const float r = 0.025F;
    for (const float shift : {0.0F, 0.3F * r, -1.1F * r}) {
        test::Particles particles;
        // Drops on a corner, on an edge and on a face of bricks, and a film through all of them.
        particles.add(shift, shift, shift);
        particles.add(shift, shift, 0.5F * brick);
        particles.add(shift, 0.5F * brick, 0.4F * brick);
        for (int i = -12; i < 12; ++i)
            for (int k = -12; k < 12; ++k)
                particles.add(static_cast<float>(2 * i) * r, shift + 0.3F * brick, static_cast<float>(2 * k) * r);
        for (const std::size_t parts : {2U, 4U, 8U})
            for (const std::uint32_t overlap : {1U, 4U})
                test::expect_the_whole(settings, particles.frame(), {.parts = parts, .overlap = overlap});
    }
}

TEST(Parts, WidenAndMendWhereNoiseReachesFar) {
    std::uint64_t unequal = 0;
    for (const double filling : {0.25, 0.5, 0.8})
        for (const std::uint32_t overlap : {1U, 4U}) {
            SCOPED_TRACE(testing::Message() << filling << " " << overlap);
            const test::Particles particles = test::noise_cube(48, 12000, filling, 0.025);
            const Settings settings = test::default_settings();
            test::expect_the_whole(settings, particles.frame(), {.parts = 8, .overlap = overlap});
            const test::FrameOfParts parts =
                test::in_parts(settings, particles.frame(), {.parts = 8, .overlap = overlap});
            if (overlap != 1) continue;
            EXPECT_GT(parts.report.unequal_seams, 0U);
            EXPECT_GT(parts.report.parts_made, 8U);
            EXPECT_GT(parts.report.greatest_overlap, 1U);
            unequal += parts.report.unequal_seams;
        }
    RecordProperty("unequal_seams", std::to_string(unequal));
}

TEST(Parts, OfAFrameWithoutParticlesAreEmpty) {
    test::expect_the_whole(test::default_settings(), test::Particles{}.frame(), {.parts = 3});
}

TEST(Parts, OfAFrameWithoutParticlesHaveItsAttributes) {
    test::ParticlesWithArrays none;
    none.add_floats("age", 1, [](std::size_t, std::size_t) { return 0.0F; });
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    for (const std::size_t parts : {1U, 3U}) {
        test::expect_the_whole(settings, none.frame(), {.parts = parts});
        EXPECT_EQ(test::in_parts(settings, none.frame(), {.parts = parts}).whole().attributes.size(), 1U);
    }
}

TEST(Parts, PassOverTheArraysThatTheFirstFrameDidNotBring) {
    test::ParticlesWithArrays particles;
    particles.particles = test::splash(51, 6);
    const auto age = [](std::size_t i, std::size_t) { return static_cast<float>(i); };
    particles.add_floats("age", 1, age);
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    AloneExchange alone;
    PartsReconstructor in_parts(settings, {Backend::cpu, 1, 0}, {.parts = 2}, alone);
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    for (int frame = 0; frame < 2; ++frame) {
        test::FrameOfParts result;
        in_parts.reconstruct(particles.frame(), result.sink());
        Mesh whole;
        reconstructor.reconstruct(particles.frame(), whole);
        test::expect_same_mesh(result.whole(), whole);
        // Neither could be an attribute.
        particles.add_floats("stress", 9, age);
        particles.add_floats("unset", 1, [](std::size_t, std::size_t) { return NAN; });
    }
}

TEST(Parts, RefuseWhatIsOutOfRange) {
    AloneExchange alone;
    const Settings settings = test::default_settings();
    EXPECT_THROW(PartsReconstructor(settings, {}, {.parts = 0}, alone), InvalidInput);
    EXPECT_THROW(PartsReconstructor(settings, {}, {.parts = max_parts + 1}, alone), InvalidInput);
    EXPECT_THROW(PartsReconstructor(settings, {}, {.parts = 2, .overlap = 0}, alone), InvalidInput);
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    const test::Particles particles = test::splash(49, 4);
    FramePart part;
    part.own.high[1] = part.own.low[1];
    EXPECT_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh), InvalidInput);
    part = {};
    part.own.high[2] = brick_end + 1;
    EXPECT_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh), InvalidInput);
    part = {};
    part.overlap = max_overlap + 1;
    EXPECT_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh), InvalidInput);
}

TEST(Parts, HoldNoMessageOncePutTogetherInOneFrame) {
    class Watched final : public PartExchange {
    public:
        std::size_t rank() const override { return 0; }
        std::size_t ranks() const override { return 1; }
        std::vector<Bytes> gather(Bytes mine) override { return alone_.gather(std::move(mine)); }
        void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override {
            for (const Bytes& bytes : from) EXPECT_EQ(bytes.capacity(), 0U);
            alone_.all_to_all(to, from);
        }

    private:
        AloneExchange alone_;
    } watched;
    PartsReconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0}, {.parts = 4}, watched);
    reconstructor.reconstruct(test::splash(3, 12).frame(), [](const FinishedPart&) {});
}

TEST(Parts, AreDealtByAllParticlesInOneFrame) {
    const Settings settings = test::default_settings();
    const test::Particles particles = test::noise_cube(52, 40'000, 1.0, settings.particle_radius);
    const std::vector<BrickBox> own = deal_bricks(brick_loads(particles.frame(), settings), 24).boxes;
    AloneExchange alone;
    PartsReconstructor reconstructor(settings, {Backend::cpu, 1, 0}, {.parts = own.size()}, alone);
    reconstructor.reconstruct(particles.frame(),
                              [&](const FinishedPart& part) { EXPECT_EQ(part.part.own, own[part.number]); });
}

TEST(Parts, RefuseRangesThatDoNotHoldTheParticles) {
    test::ParticlesWithArrays particles;
    particles.particles = test::splash(50, 4);
    particles.add_floats("age", 1, [](std::size_t i, std::size_t) { return static_cast<float>(i); });
    Settings settings = test::default_settings();
    settings.attributes = {"age"};
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    FramePart part;
    part.ranges = {{"age", 0, 0.0F, 3.0F}};
    EXPECT_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh), InvalidInput);
    part.ranges = {{"age", 0, 0.0F, INFINITY}};
    EXPECT_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh), InvalidInput);
    part.ranges = {{"age", 0, -1.0F, 1e6F}};
    EXPECT_NO_THROW(reconstructor.reconstruct_part(particles.frame(), part, mesh));
}

}  // namespace
}  // namespace meniscus
