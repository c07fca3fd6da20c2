// Frames that their owners surely did not mean have a warning with a value that fits, and no others have one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>

#include "formats/particles/particle_file.hpp"
#include "meniscus/meniscus.hpp"
#include "particles/spacing.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

constexpr double radius = 0.025;

/// A lattice two radii apart, each particle moved by up to `jitter` of that along each axis.
test::Particles lattice(int nx, int ny, int nz, float jitter = 0.0F, unsigned seed = 1, float spacing = 0.05F) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> off(-jitter, jitter);
    test::Particles particles;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                particles.add((static_cast<float>(x) + off(random)) * spacing,
                              (static_cast<float>(y) + off(random)) * spacing,
                              (static_cast<float>(z) + off(random)) * spacing);
    return particles;
}

/// Particles at random in a cube, `apart` radii apart in the mean.
test::Particles cloud(int count, float apart, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(
        -1.0F, -1.0F + apart * static_cast<float>(radius) * std::cbrt(static_cast<float>(count)));
    test::Particles particles;
    for (int i = 0; i < count; ++i) particles.add(place(random), place(random), place(random));
    return particles;
}

std::vector<Warning> warnings_of(const ParticleFrame& frame, const Settings& settings) {
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh;
    reconstructor.reconstruct(frame, mesh);
    return reconstructor.statistics().warnings;
}

std::vector<WarningCode> codes_of(const ParticleFrame& frame, const Settings& settings) {
    std::vector<WarningCode> codes;
    for (const Warning& warning : warnings_of(frame, settings)) codes.push_back(warning.code);
    return codes;
}

/// Names about the right radius where a given one is 3 to 1000 times off, and is silent where it is right.
void expect_fits(const ParticleFrame& frame, double right) {
    EXPECT_FALSE(radius_that_fits(frame, right));
    for (const double off : {1.0 / 1000, 1.0 / 10, 1.0 / 3, 3.0, 10.0, 1000.0}) {
        const auto fitting = radius_that_fits(frame, off * right);
        ASSERT_TRUE(fitting) << off << " times off";
        EXPECT_GT(fitting->radius, 0.75 * right) << off << " times off";
        EXPECT_LT(fitting->radius, 1.35 * right) << off << " times off";
        EXPECT_EQ(fitting->alone, 0.0) << off << " times off";
    }
}

/// Names a radius that joins particles that lie scattered at one `off` times too small, with the share that is alone.
void expect_scattered(const ParticleFrame& frame, double right, double off, double least_alone) {
    SCOPED_TRACE(testing::Message() << off << " times too small");
    const auto fitting = radius_that_fits(frame, right / off);
    ASSERT_TRUE(fitting);
    EXPECT_GT(fitting->radius, 0.75 * right);
    EXPECT_LT(fitting->radius, 1.35 * right);
    EXPECT_GE(fitting->alone, least_alone);
    EXPECT_LE(fitting->alone, 1.0);
    // That radius is silent.
    EXPECT_FALSE(radius_that_fits(frame, fitting->radius));
}

TEST(RadiusWarning, NamesTheRadiusOfALatticeHoweverItIsJittered) {
    for (const float jitter : {0.0F, 0.1F, 0.2F, 0.3F, 0.4F}) {
        SCOPED_TRACE(jitter);
        expect_fits(lattice(16, 16, 16, jitter).frame(), radius);
        expect_fits(lattice(40, 10, 9, jitter, 7).frame(), radius);
    }
}

TEST(RadiusWarning, NamesTheRadiusOfAFilmOfOneLayer) {
    for (const float jitter : {0.0F, 0.2F}) {
        SCOPED_TRACE(jitter);
        expect_fits(lattice(40, 40, 1, jitter).frame(), radius);
    }
}

TEST(RadiusWarning, DoesNotDependOnThePlaceTheOrderOrTheScaleOfTheParticles) {
    const test::Particles near = lattice(12, 12, 12, 0.3F);
    test::Particles far;
    test::Particles large;
    for (std::size_t i = near.count(); i-- > 0;) {
        const float* p = near.positions.data() + 3 * i;
        far.add(p[0] + 5000.0F, p[1] - 5000.0F, p[2] + 5000.0F);
        large.add(p[0] * 1e6F, p[1] * 1e6F, p[2] * 1e6F);
    }
    expect_fits(far.frame(), radius);
    expect_fits(large.frame(), radius * 1e6);
}

TEST(RadiusWarning, IsThatOfTheLevelOfMostParticles) {
    test::Particles particles = lattice(12, 12, 12, 0.2F, 3, 0.1F);  // of level 1
    particles.levels.assign(particles.count(), 1);
    const test::Particles skin = lattice(12, 12, 2, 0.2F, 4);
    particles.positions.insert(particles.positions.end(), skin.positions.begin(), skin.positions.end());
    particles.levels.resize(particles.count(), 0);
    expect_fits(particles.frame(), radius);
}

TEST(RadiusWarning, IsTheSameForQuantizedPositions) {
    const test::Particles particles = lattice(12, 12, 12, 0.3F);
    const double edge = 0.7;
    std::vector<std::uint16_t> quantized;
    for (const float x : particles.positions)
        quantized.push_back(static_cast<std::uint16_t>(std::lround((static_cast<double>(x) + 0.05) / edge * 65535.0)));
    ParticleFrame frame;
    frame.quantized = quantized;
    frame.quantization_box = {{-0.05, -0.05, -0.05}, {edge - 0.05, edge - 0.05, edge - 0.05}};
    expect_fits(frame, radius);
}

TEST(RadiusWarning, IsSilentAboutParticlesThatTheirOwnQuantizationPutsTogether) {
    const test::Particles particles = lattice(16, 16, 16, 0.3F);
    for (const double quanta_per_radius : {0.2, 0.4, 1.0}) {
        SCOPED_TRACE(quanta_per_radius);
        const double edge = 65535.0 * radius / quanta_per_radius;
        std::vector<std::uint16_t> quantized;
        for (const float x : particles.positions)
            quantized.push_back(
                static_cast<std::uint16_t>(std::lround((static_cast<double>(x) + 1.0) / edge * 65535.0)));
        ParticleFrame frame;
        frame.quantized = quantized;
        frame.quantization_box = {{-1.0, -1.0, -1.0}, {edge - 1.0, edge - 1.0, edge - 1.0}};
        EXPECT_FALSE(radius_that_fits(frame, radius));
    }
}

TEST(RadiusWarning, TakesNoParticlesAtRandomForWater) {
    for (unsigned seed = 0; seed < 20; ++seed)
        for (const int count : {300, 3000})
            for (const float apart : {3.0F, 6.0F, 20.0F, 1000.0F}) {
                const auto fitting = radius_that_fits(cloud(count, apart, seed).frame(), radius);
                EXPECT_EQ(fitting.has_value(), apart > 3.0F)
                    << count << " particles " << apart << " radii apart, seed " << seed;
                if (fitting) {
                    EXPECT_GT(fitting->alone, 0.5);
                }
            }
}

TEST(RadiusWarning, NamesTheRadiusThatJoinsParticlesAtRandom) {
    // Half of them touch no other at a radius twice too small, and nine of ten at four times.
    for (unsigned seed = 0; seed < 5; ++seed)
        for (const int count : {1000, 20000}) {
            const test::Particles particles = cloud(count, 2.0F, seed);
            for (const auto& [off, alone] : {std::pair{2.0, 0.4}, {4.0, 0.85}, {8.0, 0.97}, {10.0, 0.98}})
                expect_scattered(particles.frame(), radius, off, alone);
        }
}

TEST(RadiusWarning, SpeaksOfALatticeTwiceTooWide) {
    // As water or as scattered: the sixth of those at its border is as far as that of water.
    for (const float jitter : {0.0F, 0.1F}) expect_scattered(lattice(12, 12, 12, jitter).frame(), radius, 2.0, 0.0);
    for (const double joined : {1.1, 1.3})
        EXPECT_FALSE(radius_that_fits(lattice(12, 12, 12).frame(), radius / joined)) << joined;
}

TEST(RadiusWarning, IsSilentAboutThreadsAndAboutFilms) {
    test::Particles threads;
    for (int thread = 0; thread < 10; ++thread)
        for (int i = 0; i < 100; ++i)
            threads.add(0.05F * static_cast<float>(i), 2.0F * static_cast<float>(thread), 0.0F);
    for (const double off : {1.0, 1.2}) {
        EXPECT_FALSE(radius_that_fits(threads.frame(), radius / off));
        for (const float jitter : {0.0F, 0.2F, 0.4F})
            EXPECT_FALSE(radius_that_fits(lattice(40, 40, 1, jitter).frame(), radius / off)) << off << ' ' << jitter;
    }
}

TEST(RadiusWarning, SaysHowManyOfScatteredParticlesAreAloneUnlessTheyAreLeftOutAsSpray) {
    const test::Particles particles = cloud(3000, 20.0F, 1);
    Settings settings = test::default_settings();
    const std::vector<Warning> warnings = warnings_of(particles.frame(), settings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].code, WarningCode::radius_too_small);
    EXPECT_EQ(warnings[0].value, radius);
    EXPECT_NEAR(warnings[0].limit, 10.0 * radius, 2.5 * radius);
    EXPECT_NE(warnings[0].text.find(" % of the particles touch no other"), std::string::npos) << warnings[0].text;
    EXPECT_NE(warnings[0].text.find("would join them"), std::string::npos) << warnings[0].text;
    settings.spray = Spray::points;
    EXPECT_TRUE(codes_of(particles.frame(), settings).empty());
}

TEST(RadiusWarning, IsSilentAboutWaterAmongMoreSpray) {
    for (const int spray : {500, 2000, 8000}) {
        test::Particles particles = lattice(10, 10, 10, 0.3F);
        const test::Particles around = cloud(spray, 8.0F, 5);
        particles.positions.insert(particles.positions.end(), around.positions.begin(), around.positions.end());
        EXPECT_FALSE(radius_that_fits(particles.frame(), radius)) << spray;
    }
}

TEST(RadiusWarning, IsSilentAboutFewerThanAHundredParticlesAndAboutParticlesInOnePlace) {
    for (const double off : {0.01, 1.0, 100.0}) {
        EXPECT_FALSE(radius_that_fits(lattice(11, 3, 3).frame(), off * radius));
        for (const auto& [name, particles] : test::adversarial(static_cast<float>(radius)))
            if (particles.count() < 100) {
                EXPECT_FALSE(radius_that_fits(particles.frame(), off * radius)) << name;
            }
        test::Particles one_place;
        for (int i = 0; i < 500; ++i) one_place.add(1.0F, 2.0F, 3.0F);
        EXPECT_FALSE(radius_that_fits(one_place.frame(), off * radius));
    }
}

TEST(RadiusWarning, SpeaksOfEveryRealFrameAtThreeTimesOffAndOfNoneAtItsOwnRadius) {
    const char* folder = std::getenv("MENISCUS_DATA");
    if (folder == nullptr) GTEST_SKIP() << "MENISCUS_DATA is not set";
    int frames = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".vtk") continue;
        SCOPED_TRACE(entry.path().filename().string());
        const formats::Particles particles = formats::read_particles(entry.path());
        ++frames;
        // Lone particles, which have no spacing, and those of another simulation.
        const bool is_free = entry.path().filename().string().starts_with("free_particles");
        const double own = is_free ? 0.5 : radius;
        if (is_free || particles.count() < 100)
            EXPECT_FALSE(radius_that_fits(particles.frame(), own));
        else
            expect_fits(particles.frame(), own);
    }
    EXPECT_GT(frames, 0);
}

TEST(RadiusWarning, IsGivenWithTheRadiusAndTheOneThatFits) {
    Settings settings = test::default_settings();
    settings.cell_size = 1.0;
    const test::Particles particles = lattice(10, 10, 10, 0.2F);
    EXPECT_TRUE(warnings_of(particles.frame(), settings).empty());
    settings.particle_radius = radius / 3;
    const std::vector<Warning> small = warnings_of(particles.frame(), settings);
    ASSERT_EQ(small.size(), 1U);
    EXPECT_EQ(small[0].code, WarningCode::radius_too_small);
    EXPECT_EQ(small[0].value, radius / 3);
    EXPECT_EQ(small[0].limit, radius_that_fits(particles.frame(), radius / 3)->radius);
    EXPECT_NE(small[0].text.find("0.00833333 is too small"), std::string::npos) << small[0].text;
    settings.particle_radius = radius * 3;
    const std::vector<Warning> large = warnings_of(particles.frame(), settings);
    ASSERT_EQ(large.size(), 1U);
    EXPECT_EQ(large[0].code, WarningCode::radius_too_large);
}

TEST(EmptySurfaceWarning, HasTheGreatestValueThatWasSampled) {
    const test::Particles particles = lattice(6, 6, 6);
    for (const Field field : {Field::color, Field::density})  // that of the smooth field is below 1
        for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
            Settings settings = test::default_settings();
            settings.field = field;
            settings.mode = mode;
            settings.iso = 3.0;
            const std::vector<Warning> warnings = warnings_of(particles.frame(), settings);
            ASSERT_EQ(warnings.size(), 1U) << name_of(field);
            EXPECT_EQ(warnings[0].code, WarningCode::empty_surface);
            EXPECT_EQ(warnings[0].limit, 3.0);
            EXPECT_GT(warnings[0].value, 0.6);
            EXPECT_LT(warnings[0].value, 3.0);
            // A surface below that value is there.
            settings.iso = 0.99 * warnings[0].value;
            EXPECT_TRUE(warnings_of(particles.frame(), settings).empty()) << name_of(field);
        }
}

TEST(EmptySurfaceWarning, SaysThatAllIsSprayOrThatTheDomainHoldsNothing) {
    test::Particles lone;
    for (int i = 0; i < 5; ++i) lone.add(static_cast<float>(i), 0.0F, 0.0F);
    Settings settings = test::default_settings();
    EXPECT_TRUE(warnings_of(lone.frame(), settings).empty());
    settings.spray = Spray::discard;
    std::vector<Warning> warnings = warnings_of(lone.frame(), settings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].code, WarningCode::empty_surface);
    EXPECT_EQ(warnings[0].value, 0.0);
    EXPECT_NE(warnings[0].text.find("all 5 particles lie alone"), std::string::npos) << warnings[0].text;

    settings.spray = Spray::keep;
    settings.domain = Box{{0.1, -0.4, -0.4}, {0.9, 0.4, 0.4}};
    warnings = warnings_of(lone.frame(), settings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].text.find("none lies in the domain"), std::string::npos) << warnings[0].text;
    EXPECT_LT(warnings[0].value, settings.iso);  // samples beyond the border are not counted
}

TEST(EmptySurfaceWarning, IsGivenInTheSmoothFieldWhereDropsAreSmallerThanCells) {
    test::Particles lone;
    lone.add(0.011F, 0.004F, 0.006F);
    for (const Mode mode : choices<Mode>) {
        Settings settings = test::default_settings();
        settings.mode = mode;
        settings.iso = 0.999;
        const std::vector<Warning> warnings = warnings_of(lone.frame(), settings);
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_EQ(warnings[0].code, WarningCode::empty_surface);
        EXPECT_LT(warnings[0].value, 0.999);
        EXPECT_EQ(warnings[0].limit, 0.999);
    }
}

TEST(EmptySurfaceWarning, IsNotGivenWithoutParticles) {
    EXPECT_TRUE(warnings_of({}, test::default_settings()).empty());
}

TEST(CellSizeWarning, SpeaksFromWhereDropsOfSingleParticlesVanish) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> off(-0.1F, 0.1F);
    test::Particles lone;
    for (int z = 0; z < 7; ++z)
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 7; ++x)
                lone.add(0.4F * static_cast<float>(x) + off(random), 0.4F * static_cast<float>(y) + off(random),
                         0.4F * static_cast<float>(z) + off(random));
    for (const Field field : {Field::smooth, Field::color}) {
        Settings settings = test::default_settings();
        settings.field = field;
        settings.cell_size = 1.5;
        // The lattice of drops has a spacing that would fit a larger radius: that is another warning.
        const auto speaks = [&] {
            const auto codes = codes_of(lone.frame(), settings);
            return std::count(codes.begin(), codes.end(), WarningCode::cell_size_too_large) == 1;
        };
        EXPECT_FALSE(speaks());
        EXPECT_EQ(test::check(test::reconstruct(settings, lone.frame())).components, 343U);
        settings.cell_size = 2.0;
        EXPECT_TRUE(speaks());
        EXPECT_LT(test::check(test::reconstruct(settings, lone.frame())).components, 343U);
    }
}

TEST(CellSizeWarning, IsHeldAgainstTheFinestParticlesThatAreThere) {
    test::Particles particles = lattice(6, 6, 6, 0.0F, 1, 0.1F);
    particles.levels.assign(particles.count(), 1);
    Settings settings = test::default_settings();
    settings.cell_size = 3.0;
    EXPECT_TRUE(codes_of(particles.frame(), settings).empty());
    settings.cell_size = 3.1;
    const std::vector<Warning> warnings = warnings_of(particles.frame(), settings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].code, WarningCode::cell_size_too_large);
    EXPECT_EQ(warnings[0].value, 3.1 * radius);
    EXPECT_EQ(warnings[0].limit, 3.0 * radius);
}

TEST(SupportWarning, SpeaksFromWhereWaterAtRestIsNotWhole) {
    const test::Particles water = lattice(5, 5, 5);
    for (const Field field : {Field::color, Field::density})
        for (const double iso : {0.4, 0.6}) {
            SCOPED_TRACE(testing::Message() << name_of(field) << " at " << iso);
            Settings settings = test::default_settings();
            settings.field = field;
            settings.iso = iso;
            settings.mode = Mode::uniform;
            settings.cell_size = 0.2;  // ten to a particle, so that the places between particles are sampled
            settings.smoothing_length = 0.9;
            const std::vector<Warning> warnings = warnings_of(water.frame(), settings);
            ASSERT_EQ(warnings.size(), 1U);
            EXPECT_EQ(warnings[0].code, WarningCode::support_too_small);
            EXPECT_EQ(warnings[0].value, 1.8 * radius);
            settings.smoothing_length = warnings[0].limit / radius / 2.0;
            EXPECT_TRUE(warnings_of(water.frame(), settings).empty());
            EXPECT_EQ(test::check(test::reconstruct(settings, water.frame())).components, 1U);
            settings.smoothing_length = *settings.smoothing_length - 0.03;
            EXPECT_EQ(warnings_of(water.frame(), settings).size(), 1U);
            EXPECT_GT(test::check(test::reconstruct(settings, water.frame())).components, 1U);
        }
}

TEST(Warnings, AreNoneForAThresholdThatNoSupportReachesButThatOfTheEmptySurface) {
    Settings settings = test::default_settings();
    settings.field = Field::color;
    settings.iso = 5.0;
    EXPECT_EQ(codes_of(lattice(6, 6, 6).frame(), settings), std::vector{WarningCode::empty_surface});
}

TEST(Warnings, AreThoseOfTheLastFrameAlone) {
    Settings settings = test::default_settings();
    settings.particle_radius = radius / 3;
    settings.cell_size = 1.0;
    Reconstructor reconstructor(settings, {Backend::cpu, 1});
    Mesh mesh;
    const test::Particles wrong = lattice(8, 8, 8), right = lattice(8, 8, 8, 0.0F, 1, 0.05F / 3);
    for (int i = 0; i < 2; ++i) {
        reconstructor.reconstruct(wrong.frame(), mesh);
        EXPECT_EQ(reconstructor.statistics().warnings.size(), 1U);
        reconstructor.reconstruct(right.frame(), mesh);
        EXPECT_TRUE(reconstructor.statistics().warnings.empty());
    }
}

}  // namespace
}  // namespace meniscus
