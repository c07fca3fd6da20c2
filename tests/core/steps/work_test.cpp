// A frame's work is estimated before it is done, and a reconstruction ends soon after it is asked to.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Settings settings_of(Field field, double cell_size, Mode mode = Mode::adaptive) {
    Settings settings = test::default_settings();
    settings.particle_radius = 1.0;
    settings.field = field;
    settings.cell_size = cell_size;
    settings.mode = mode;
    return settings;
}

BackendOptions limited() {
    BackendOptions options{Backend::cpu, 2, std::size_t{4} << 30};
    options.work_limit = 20.0;
    return options;
}

/// A jittered block of particles two radii apart.
test::Particles evenly_spread(int count) {
    const int side = static_cast<int>(std::ceil(std::cbrt(count)));
    std::mt19937 random(7);
    std::uniform_real_distribution<float> jitter(-0.2F, 0.2F);
    test::Particles particles;
    for (int i = 0; i < count; ++i) {
        const int layer = i / side / side;
        particles.add(2.0F * static_cast<float>(i % side) + jitter(random),
                      2.0F * static_cast<float>(i / side % side) + jitter(random),
                      2.0F * static_cast<float>(layer) + jitter(random));
    }
    return particles;
}

/// `number` clumps, 50 radii apart, each of `of` particles within `size` of its middle along each axis.
test::Particles clumps(int number, int of, float size) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-size, size);
    test::Particles particles;
    for (int c = 0; c < number; ++c) {
        const int row = c / 16;
        for (int i = 0; i < of; ++i)
            particles.add(50.0F * static_cast<float>(c % 16) + place(random),
                          50.0F * static_cast<float>(row) + place(random), place(random));
    }
    return particles;
}

/// The particles of both in turn, so that those of neither lie together.
test::Particles shuffled_together(const test::Particles& a, const test::Particles& b) {
    test::Particles all;
    for (std::size_t i = 0; i < std::max(a.positions.size(), b.positions.size()); i += 3)
        for (const test::Particles* each : {&a, &b})
            if (i < each->positions.size()) all.add(each->positions[i], each->positions[i + 1], each->positions[i + 2]);
    return all;
}

/// The refusal's text; empty if the frame was not refused.
std::string refusal_of(Reconstructor& reconstructor, const test::Particles& particles) {
    Mesh mesh;
    try {
        reconstructor.reconstruct(particles.frame(), mesh);
        return {};
    } catch (const LimitExceeded& error) {
        return error.what();
    }
}

struct Attack {
    std::string name;
    Settings settings;
    test::Particles particles;
};

constexpr int megabyte = 87'000;  // particles of 12 bytes

std::vector<Attack> attacks() {
    std::vector<Attack> all;
    Settings coarse = settings_of(Field::color, 10.0);
    coarse.smoothing_length = 0.1;
    for (const float apart : {0.0F, 1e-6F, 0.05F})
        all.push_back(
            {"one place at coarse cells, apart " + std::to_string(apart), coarse, clumps(1, megabyte, apart)});
    all.push_back({"half of it spread, half in one place, coarse", coarse,
                   shuffled_together(evenly_spread(megabyte / 2), clumps(1, megabyte / 2, 0.0F))});
    Settings very_coarse = settings_of(Field::smooth, 1000.0);
    all.push_back({"one place at very coarse cells", very_coarse, clumps(1, megabyte, 0.0F)});
    for (const Field field : {Field::smooth, Field::color, Field::density})
        for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
            const std::string of = std::string(name_of(field)) + ", " + std::string(name_of(mode));
            const Settings settings = settings_of(field, 0.5, mode);
            all.push_back({"one place, " + of, settings, clumps(1, megabyte, 0.0F)});
            all.push_back({"a ball of one radius, " + of, settings, clumps(1, megabyte, 0.5F)});
            all.push_back({"half of it spread, half in one place, " + of, settings,
                           shuffled_together(evenly_spread(megabyte / 2), clumps(1, megabyte / 2, 0.01F))});
            all.push_back({"twenty clumps, " + of, settings, clumps(20, megabyte / 20, 0.1F)});
        }
    Settings fine = settings_of(Field::color, 1.0 / 64.0);
    all.push_back({"a clump at the finest cells", fine, clumps(1, 4000, 0.0F)});
    all.push_back({"twenty clumps at the finest cells", fine, clumps(20, 800, 0.0F)});
    fine.edge_points = Bisection{7};
    all.push_back({"a clump at the finest cells, bisected", fine, clumps(1, 4000, 0.0F)});
    Settings smooth = settings_of(Field::smooth, 6.0 / 256.0);
    all.push_back({"a clump at the finest cells of the smooth field", smooth, clumps(1, 4000, 0.0F)});
    test::Particles line, plane;
    for (int i = 0; i < megabyte; ++i) {
        const int along_line = i / 3000, row = i / 5100;
        line.add(static_cast<float>(along_line) * 0.1F, 0.0F, 0.0F);
        plane.add(static_cast<float>(i / 300 % 17) * 0.2F, static_cast<float>(row) * 0.2F, 0.0F);
    }
    all.push_back({"a line of coincident particles", settings_of(Field::smooth, 0.5), line});
    all.push_back({"a plane of coincident particles", settings_of(Field::smooth, 0.5), plane});
    test::Particles levels = shuffled_together(evenly_spread(megabyte / 2), clumps(1, megabyte / 2, 30.0F));
    for (std::size_t i = 0; i < levels.count(); ++i) levels.levels.push_back(i % 2 == 0 ? 0 : 3);
    all.push_back({"large particles all over small ones", settings_of(Field::smooth, 0.5), levels});
    return all;
}

TEST(Work, EveryAttackOfAMegabyteEndsOrIsRefusedSoon) {
    for (const Attack& attack : attacks()) {
        SCOPED_TRACE(attack.name);
        Reconstructor reconstructor(attack.settings, limited());
        const auto start = Clock::now();
        const std::string refusal = refusal_of(reconstructor, attack.particles);
        EXPECT_LT(seconds_since(start), 10.0) << refusal;
        if (std::getenv("MENISCUS_SHOW_WORK") != nullptr)
            std::printf("%7.3f s  %s: %s\n", seconds_since(start), attack.name.c_str(), refusal.c_str());
    }
}

TEST(Work, ARefusalTellsTheEstimateAndTheLimitAndLeavesTheReconstructorUsable) {
    Reconstructor reconstructor(settings_of(Field::smooth, 0.5), limited());
    const std::string sums = refusal_of(reconstructor, clumps(1, 40'000, 0.0F));
    EXPECT_NE(sums.find("the field at the particles' places is a sum over about "), std::string::npos) << sums;
    EXPECT_NE(sums.find(" particles near them, at most 268435456 are summed over"), std::string::npos) << sums;
    EXPECT_NE(sums.find("in the unit of the particle radius"), std::string::npos) << sums;
    EXPECT_EQ(refusal_of(reconstructor, evenly_spread(1000)), "");
    Reconstructor fine(settings_of(Field::color, 1.0 / 64.0), limited());
    const std::string cells = refusal_of(fine, clumps(1, 4000, 0.0F));
    EXPECT_NE(cells.find("the field at the base cells is a sum over about "), std::string::npos) << cells;
}

TEST(Work, WaterSprayAndMixedLevelsPassAtAnyCellSize) {
    std::vector<test::Particles> all{test::splash(3, 30, 1.0F), evenly_spread(40'000)};
    test::Particles& drops = all.emplace_back();
    for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 10; ++x)
                drops.add(9.0F * static_cast<float>(x), 9.0F * static_cast<float>(y), 9.0F * static_cast<float>(z));
    test::Particles& levels = all.emplace_back(evenly_spread(20'000));
    for (std::size_t i = 0; i < levels.count(); ++i) levels.levels.push_back(i % 512 == 0 ? 3 : 0);
    for (const Field field : {Field::smooth, Field::color, Field::density})
        for (const double cell_size : {0.25, 0.5, 1.0, 6.0, 100.0}) {
            Reconstructor reconstructor(settings_of(field, cell_size), limited());
            for (const test::Particles& particles : all)
                EXPECT_EQ(refusal_of(reconstructor, particles), "") << name_of(field) << ", " << cell_size;
        }
    Settings cropped = settings_of(Field::smooth, 0.25);
    cropped.domain = Box{{10.0, 10.0, 10.0}, {60.0, 60.0, 10.5}};
    Reconstructor reconstructor(cropped, limited());
    EXPECT_EQ(refusal_of(reconstructor, all[1]), "") << "a domain leaves cells out, not particles";
}

TEST(Work, ParticlesAllAloneAreRefusedOnlyWhereTheyAreMany) {
    const auto alone = [](int side) {
        test::Particles particles;
        for (int z = 0; z < side; ++z)
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    particles.add(13.0F * static_cast<float>(x), 13.0F * static_cast<float>(y),
                                  13.0F * static_cast<float>(z));
        return particles;
    };
    Reconstructor reconstructor(settings_of(Field::smooth, 0.5), limited());
    EXPECT_EQ(refusal_of(reconstructor, alone(20)), "");
    const auto start = Clock::now();
    const std::string refusal = refusal_of(reconstructor, alone(44));
    EXPECT_LT(seconds_since(start), 10.0);
    EXPECT_NE(refusal.find("the particles reach "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(" base cells, at most "), std::string::npos) << refusal;
}

TEST(Work, IsNotLimitedUnlessThatIsAskedFor) {
    Reconstructor reconstructor(settings_of(Field::color, 0.5), {Backend::cpu, 2, 0});
    EXPECT_EQ(refusal_of(reconstructor, clumps(20, 1000, 0.0F)), "");
}

TEST(Stop, EndsAReconstructionSoonWhereverItIsAndTheNextFrameIsAsEver) {
    // Long enough that the flag is raised in all of its stages.
    const test::Particles particles = evenly_spread(60'000);
    const test::Particles small = test::splash(5, 10, 1.0F);
    const Settings settings = settings_of(Field::smooth, 0.25);
    const std::string expected = mesh_sha256(test::reconstruct(settings, small.frame()));
    const auto flag = std::make_shared<StopFlag>();
    BackendOptions options{Backend::cpu, 2, 0};
    options.stop = flag;
    Reconstructor reconstructor(settings, options);
    Mesh mesh;
    const auto start = Clock::now();
    reconstructor.reconstruct(particles.frame(), mesh);
    Clock::duration whole = Clock::now() - start;
    int stopped = 0;
    constexpr int tries = 12;
    for (int i = 0; i < tries || stopped <= tries / 2; ++i) {
        ASSERT_LT(i, 10 * tries) << "stopped " << stopped << " times";
        flag->lower();
        Clock::time_point raised;
        std::thread raises([&, before = whole * (i % tries) / tries] {
            std::this_thread::sleep_for(before);
            raised = Clock::now();
            flag->raise();
        });
        const auto begun = Clock::now();
        try {
            reconstructor.reconstruct(particles.frame(), mesh);
            // Other programs had held up the one that was measured.
            whole = std::min(whole, Clock::now() - begun);
            raises.join();
        } catch (const Stopped&) {
            const auto ended = Clock::now();
            raises.join();
            ++stopped;
            EXPECT_LT(std::chrono::duration<double>(ended - raised).count(), 1.0) << i;
            EXPECT_TRUE(mesh.triangles.empty());
        }
        flag->lower();
        reconstructor.reconstruct(small.frame(), mesh);
        EXPECT_EQ(mesh_sha256(mesh), expected) << "after a stop at " << i % tries << "/" << tries;
    }
}

TEST(Stop, EndsWhatBeginsAfterItWithoutAnyWork) {
    const auto flag = std::make_shared<StopFlag>();
    BackendOptions options{Backend::cpu, 1, 0};
    options.stop = flag;
    Reconstructor reconstructor(settings_of(Field::smooth, 0.5), options);
    Mesh mesh;
    flag->raise();
    EXPECT_THROW(reconstructor.reconstruct(test::splash(1, 6, 1.0F).frame(), mesh), Stopped);
    flag->lower();
    EXPECT_NO_THROW(reconstructor.reconstruct(test::splash(1, 6, 1.0F).frame(), mesh));
}

}  // namespace
}  // namespace meniscus
