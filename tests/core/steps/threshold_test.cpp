// A higher iso value gives less water, down to nothing: in the smooth field, too, whose lift depends on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "meniscus/names.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

constexpr float particle_radius = 0.025F;
constexpr std::array thresholds{0.05, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99};

Settings settings_at(double iso, double cell_size) {
    Settings settings = test::default_settings();
    settings.iso = iso;
    settings.cell_size = cell_size;
    return settings;
}

double volume_at(const Settings& settings, const test::Particles& particles) {
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(particles.frame(), mesh);
    EXPECT_TRUE(test::check(mesh).closed_manifold());
    return reconstructor.statistics().volume;
}

/// Volumes above zero, each less than the one before it; where some particles are lifted, up to 0.6 perhaps as large.
void expect_less_and_less(Settings settings, const test::Particles& particles, bool some_are_lifted = false) {
    for (const Mode mode : choices<Mode>) {
        settings.mode = mode;
        double before = std::numeric_limits<double>::infinity();
        for (const double iso : thresholds) {
            settings.iso = iso;
            const double now = volume_at(settings, particles);
            const double equal = some_are_lifted && iso <= 0.6 ? 1e-5 * now : 0.0;
            EXPECT_LT(now, before + equal) << "at " << iso << ", " << name_of(mode);
            EXPECT_GT(now, 0.0) << "at " << iso << ", " << name_of(mode);
            before = now;
        }
    }
}

/// Particles in a row, some radii apart.
test::Particles row_of(int count, float apart) {
    test::Particles particles;
    for (int i = 0; i < count; ++i)
        particles.add(0.011F + static_cast<float>(i) * apart * particle_radius, 0.007F, -0.003F);
    return particles;
}

TEST(Threshold, AHigherOneGivesLessWater) {
    for (const std::uint32_t smoothness : {5U, 6U, 7U}) {
        SCOPED_TRACE(smoothness);
        Settings settings = settings_at(0.6, 0.5);
        settings.smoothness = smoothness;
        expect_less_and_less(settings, test::splash(31, 8));
    }
}

TEST(Threshold, AHigherOneGivesLessOfParticlesAloneInPairsAndInSmallGroups) {
    for (const std::uint32_t smoothness : {5U, 6U, 7U}) {
        Settings settings = settings_at(0.6, 0.1);
        settings.smoothness = smoothness;
        SCOPED_TRACE(smoothness);
        expect_less_and_less(settings, row_of(1, 0.0F));
        for (const int count : {2, 4})
            for (const float apart : {0.0F, 1.0F, 2.6F}) {
                SCOPED_TRACE(testing::Message() << count << " particles, " << apart << " radii apart");
                expect_less_and_less(settings, row_of(count, apart), count > 2);
            }
    }
}

TEST(Threshold, AParticleAloneIsTheBallInWhichItsKernelIsAboveIt) {
    for (const double iso : thresholds) {
        const double reach = 3.12 * static_cast<double>(particle_radius) * std::sqrt(1.0 - std::cbrt(iso));
        const double ball = 4.0 / 3.0 * std::numbers::pi * reach * reach * reach;
        // The finest cells that there may be, or fine enough for its facets.
        const double cell = std::max(0.06 * reach / static_cast<double>(particle_radius), 0.024);
        EXPECT_NEAR(volume_at(settings_at(iso, cell), row_of(1, 0.0F)) / ball, 1.0, 0.05) << iso;
    }
}

TEST(Threshold, OfOneOrMoreIsRefusedInTheSmoothFieldAlone) {
    for (const double iso : {1.0, 0.99999999, 5.0, 5000.0}) {
        Settings settings = settings_at(iso, 0.5);
        try {
            validate(settings);
            ADD_FAILURE() << iso << " is taken";
        } catch (const InvalidInput& e) {
            EXPECT_NE(std::string(e.what()).find("must be less than 1 with the field smooth"), std::string::npos)
                << e.what();
        }
        settings.field = Field::color;
        EXPECT_NO_THROW(validate(settings));
    }
    EXPECT_NO_THROW(validate(settings_at(0.999999, 0.5)));
}

}  // namespace
}  // namespace meniscus
