// Bad input is refused with the value and the limit, and leaves the reconstructor usable.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"

namespace meniscus {
namespace {

TEST(Validation, RefusesEverySettingOutOfRangeNamingItsValue) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    struct Case {
        std::function<void(Settings&)> change;
        std::string named;
    };
    const std::vector<Case> cases{
        {[](Settings& s) { s.particle_radius = 0.0; }, "particle radius is 0"},
        {[](Settings& s) { s.particle_radius = -1.0; }, "particle radius is -1"},
        {[&](Settings& s) { s.particle_radius = nan; }, "particle radius is nan"},
        {[&](Settings& s) { s.particle_radius = inf; }, "particle radius is inf"},
        {[](Settings& s) {
             s.field = Field::color;
             s.smoothing_length = 0.0;
         },
         "smoothing length is 0"},
        {[](Settings& s) { s.smoothing_length = 2.0; }, "smoothing length is 2, but the field is smooth"},
        {[](Settings& s) { s.smoothing_length = 2.0; }, "use --smoothness, or take --field color"},
        {[](Settings& s) { s.cell_size = 1e7; }, "cell size is 10000000 radii, must be at most 1024"},
        {[](Settings& s) { s.smoothness = 4; }, "smoothness is 4, must be 5 to 7"},
        {[](Settings& s) { s.smoothness = 8; }, "smoothness is 8, must be 5 to 7"},
        {[](Settings& s) {
             s.field = Field::density;
             s.smoothness = 6;
         },
         "smoothness is 6, but the field is density"},
        {[](Settings& s) {
             s.field = Field::color;
             s.spray = Spray::discard;
         },
         "spray is discard, but the field is color"},
        {[](Settings& s) { s.cell_size = -0.5; }, "cell size is -0.5"},
        {[](Settings& s) { s.cell_size = 0.015; }, "spans 400 cells"},
        {[](Settings& s) { s.iso = 0.0; }, "iso value is 0"},
        {[](Settings& s) { s.iso = 1.0; }, "iso value is 1, must be less than 1 with the field smooth"},
        {[](Settings& s) { s.iso = 1e-60; }, "iso value is 1e-60, must be greater than 0 as a float32"},
        {[](Settings& s) { s.criterion = CurvatureCriterion{0.0}; }, "tolerance is 0"},
        {[&](Settings& s) { s.criterion = CurvatureCriterion{nan}; }, "tolerance is nan"},
        {[](Settings& s) { s.criterion = CountCriterion{0}; }, "count threshold is 0"},
        {[](Settings& s) { s.edge_points = Bisection{8}; }, "bisection steps are 8, must be 1 to 7"},
        {[](Settings& s) { s.edge_points = Bisection{0}; }, "bisection steps are 0"},
        {[](Settings& s) {
             s.domain = Box{{0, 0, 0}, {1, -1, 1}};
         },
         "along y"},
        {[&](Settings& s) {
             s.domain = Box{{0, 0, nan}, {1, 1, 1}};
         },
         "along z"},
        {[](Settings& s) {
             s.particle_radius = 1e-300;
             s.field = Field::color;
             s.cell_size = 1e-50;
             s.smoothing_length = 1e-50;
         },
         "cell size in world units is 0"},
        // Arithmetic that would leave its type: 4096 / c, c cubed, 16 / l^3, the iso value's multiples.
        {[](Settings& s) { s.particle_radius = 1e-310; }, "particle radius is 1e-310, must be 1e-60 to 1e+60"},
        {[](Settings& s) { s.particle_radius = 1e-320; }, "must be 1e-60 to 1e+60"},
        {[](Settings& s) { s.particle_radius = 1e300; }, "particle radius is 1e+300, must be 1e-60 to 1e+60"},
        {[](Settings& s) {
             s.particle_radius = 1e-59;
             s.field = Field::color;
             s.cell_size = 0.01;
             s.smoothing_length = 0.01;
         },
         "cell size in world units is 1e-61, must be 1e-60 to 1e+60"},
        {[](Settings& s) {
             s.field = Field::color;
             s.cell_size = 1e10;
         },
         "cell size is 1e+10, must be 1e-09 to 1e+09"},
        {[](Settings& s) {
             s.field = Field::color;
             s.smoothing_length = 1e-14;
         },
         "smoothing length is 1e-14, must be 1e-06 to 1000000"},
        {[](Settings& s) { s.iso = 3e38; }, "iso value is 3e+38, must be at most 1e+30"},
        {[](Settings& s) { s.iso = 1e300; }, "iso value is 1e+300, must be at most 1e+30"},
    };
    for (const Case& c : cases) {
        Settings settings = test::default_settings();
        c.change(settings);
        const std::string message = test::refusal([&] { Reconstructor reconstructor(settings); });
        EXPECT_NE(message.find(c.named), std::string::npos) << "expected '" << c.named << "', got '" << message << "'";
    }
    EXPECT_EQ(test::refusal([] { validate(test::default_settings()); }), "");
}

TEST(Validation, RefusesMoreThreadsThanAreOfUse) {
    const std::string message = test::refusal([&] {
        Reconstructor reconstructor(test::default_settings(), {Backend::cpu, max_threads + 1, 0});
    });
    EXPECT_NE(message.find("1025"), std::string::npos) << message;
    EXPECT_NE(message.find("1024"), std::string::npos) << message;
}

TEST(Validation, RefusesEveryBadFrameNamingTheParticleAndGoesOn) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const test::Particles good = test::splash(71, 6);
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh;
    reconstructor.reconstruct(good.frame(), mesh);
    const std::string expected = mesh_sha256(mesh);

    const auto with = [&](std::size_t at, float value) {
        test::Particles bad = good;
        bad.positions[at] = value;
        return bad;
    };
    struct Case {
        test::Particles particles;
        std::string named;
    };
    std::vector<Case> cases{{with(7, nan), "particle 2 has y = nan"},
                            {with(9, inf), "particle 3 has x = inf"},
                            {with(11, -inf), "particle 3 has z = -inf"},
                            {with(0, 3e7F), "particle 0 has x = 30000000"}};
    Case& uneven = cases.emplace_back(Case{good, "coordinates, must be three per particle"});
    uneven.particles.positions.pop_back();
    Case& short_levels = cases.emplace_back(Case{good, "5 levels for"});
    short_levels.particles.levels.assign(5, 0);
    Case& high_level = cases.emplace_back(Case{good, "particle 4 has level 4, must be 0 to 3"});
    high_level.particles.levels.assign(good.count(), 0);
    high_level.particles.levels[4] = 4;
    for (const Case& c : cases) {
        const std::string message = test::refusal([&] { reconstructor.reconstruct(c.particles.frame(), mesh); });
        EXPECT_NE(message.find(c.named), std::string::npos) << "expected '" << c.named << "', got '" << message << "'";
        EXPECT_TRUE(mesh.triangles.empty());
        reconstructor.reconstruct(good.frame(), mesh);
        EXPECT_EQ(mesh_sha256(mesh), expected);
    }
}

TEST(Validation, AFrameThatIsRefusedLeavesTheSurfaceBeforeIt) {
    const test::Particles good = test::splash(71, 6);
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh, expected, coarse;
    reconstructor.reconstruct(good.frame(), mesh);
    reconstructor.emit_capped(1, expected);
    const std::uint64_t triangles = reconstructor.statistics().triangles;
    test::Particles bad = good;
    bad.positions[4] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(reconstructor.reconstruct(bad.frame(), mesh), InvalidInput);
    EXPECT_TRUE(mesh.triangles.empty());
    reconstructor.emit_capped(1, coarse);
    EXPECT_EQ(mesh_sha256(coarse), mesh_sha256(expected));
    EXPECT_EQ(reconstructor.statistics().triangles, triangles);
}

TEST(Validation, SettingsAtTheEndsOfTheirRangesStillGiveASurface) {
    const test::Particles good = test::splash(71, 6);
    for (const double scale : {1e-30, 1e-6, 1e30}) {
        test::Particles scaled = good;
        for (float& p : scaled.positions) p = static_cast<float>(static_cast<double>(p) * scale);
        Settings settings = test::default_settings();
        settings.particle_radius *= scale;
        const Mesh mesh = test::reconstruct(settings, scaled.frame());
        EXPECT_FALSE(mesh.triangles.empty()) << scale;
        EXPECT_TRUE(std::isfinite(mesh.cell_size)) << scale;
    }
}

TEST(Validation, AcceptsTheFarthestPositionAndRefusesTheNext) {
    Settings settings;
    settings.particle_radius = 2.0;
    settings.cell_size = 0.5;  // c = 1
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    const float limit = 4.0F * ((1 << 20) - 1 - 128);
    test::Particles last, beyond;
    last.add(limit, -limit, limit);
    beyond.add(limit + 1.0F, 0.0F, 0.0F);
    reconstructor.reconstruct(last.frame(), mesh);
    EXPECT_FALSE(mesh.triangles.empty());
    EXPECT_NE(test::refusal([&] { reconstructor.reconstruct(beyond.frame(), mesh); }).find("farther from the origin"),
              std::string::npos);
}

TEST(Validation, RefusesAQuantizationBoxThatIsNotOne) {
    const std::vector<std::uint16_t> positions{0, 1, 2, 3, 4, 5};
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh;
    ParticleFrame frame;
    frame.quantized = positions;
    frame.quantization_box = {{0, 0, 0}, {1, -1, 1}};
    EXPECT_NE(test::refusal([&] {
                  reconstructor.reconstruct(frame, mesh);
              }).find("quantization box runs from 0 to -1 along y"),
              std::string::npos);
    frame.quantization_box = {{0, 0, 0}, {1, 1e12, 1}};
    EXPECT_NE(test::refusal([&] { reconstructor.reconstruct(frame, mesh); }).find("farther from the origin"),
              std::string::npos);
    // The difference of its corners is no number.
    frame.quantization_box = {{-1.7e308, 0, 0}, {1.7e308, 1, 1}};
    EXPECT_NE(test::refusal([&] { reconstructor.reconstruct(frame, mesh); }).find("farther from the origin"),
              std::string::npos);
    frame.quantization_box = {{0, 0, 0}, {1, 0, 1}};  // flat is fine
    reconstructor.reconstruct(frame, mesh);
    EXPECT_FALSE(mesh.triangles.empty());
}

TEST(Validation, RefusesParticlesThatCrowdBeforeTheirFieldIsSummed) {
    // As with all particles in one place, or positions in meters and a radius in millimeters: minutes for this one,
    // hours for more.
    test::Particles crowd;
    for (int i = 0; i < 200'000; ++i) crowd.add(1e-7F * static_cast<float>(i), 0.0F, 0.0F);
    const test::Particles good = test::splash(1, 6);
    Reconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0});
    Mesh mesh;
    try {
        reconstructor.reconstruct(crowd.frame(), mesh);
        ADD_FAILURE() << "not refused";
    } catch (const LimitExceeded& error) {
        EXPECT_NE(std::string(error.what()).find("200000 others in the mean"), std::string::npos) << error.what();
    }
    reconstructor.reconstruct(good.frame(), mesh);
    EXPECT_FALSE(mesh.triangles.empty());
    // Few enough may lie in one place.
    crowd.positions.resize(3 * std::size_t{4096});
    EXPECT_NO_THROW(reconstructor.reconstruct(crowd.frame(), mesh));
    // Cells larger than the support hold more particles, which is no crowd.
    Settings coarse = test::default_settings();
    coarse.cell_size = 6.0;
    EXPECT_NO_THROW(test::reconstruct(coarse, test::splash(1, 40).frame()));
}

TEST(Validation, SaysWhichRadiusFitsParticlesThatCrowd) {
    test::Particles water;
    for (int z = 0; z < 30; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x)
                water.add(0.05F * static_cast<float>(x), 0.05F * static_cast<float>(y), 0.05F * static_cast<float>(z));
    Settings settings;
    settings.particle_radius = 1.0;
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    try {
        reconstructor.reconstruct(water.frame(), mesh);
        ADD_FAILURE() << "not refused";
    } catch (const LimitExceeded& error) {
        EXPECT_TRUE(std::string(error.what()).ends_with("A particle radius of about 0.022 fits their spacing"))
            << error.what();
    }
}

TEST(Validation, TheCudaBackendSaysWhyItCannotBeUsed) {
    const int no_device = 1000;
    EXPECT_NE(test::refusal([&] {
                  Reconstructor reconstructor(test::default_settings(), {Backend::cuda, 1, 0, no_device});
              }).find("CUDA backend cannot be used: "),
              std::string::npos);
    const BackendDescription description = describe_backend(Backend::automatic, no_device);
    EXPECT_EQ(description.name, "cpu");
    EXPECT_FALSE(description.reason.empty());
}

TEST(Validation, TheCpuBackendTakesNoParticlesFromAGpuAndSaysSo) {
    Reconstructor cpu(test::default_settings(), {Backend::cpu, 1, 0});
    const test::Particles particles = test::splash(1, 4);
    Mesh mesh;
    cpu.reconstruct(particles.frame(), mesh);
    const std::string expected = mesh_sha256(mesh);
    const DeviceParticleFrame frame{particles.positions.data(), particles.count()};
    const auto is_named = [](const std::string& message) {
        return message.find("the CPU backend takes no particles from a GPU") != std::string::npos;
    };
    EXPECT_TRUE(is_named(test::refusal([&] { static_cast<void>(cpu.reconstruct_on_device(frame)); })));
    EXPECT_TRUE(is_named(test::refusal([&] { static_cast<void>(cpu.reconstruct_for_download(frame, mesh)); })));
    EXPECT_TRUE(is_named(test::refusal([&] { cpu.reconstruct(frame, mesh); })));
    EXPECT_NE(test::refusal([&] {
                  static_cast<void>(cpu.pack_on_device());
              }).find("the CPU backend packs no bricks on a GPU"),
              std::string::npos);
    EXPECT_NE(test::refusal([&] {
                  cpu.reconstruct(DeviceParticleFrame{nullptr, 5}, mesh);
              }).find("its positions are null"),
              std::string::npos);
    cpu.emit_capped(3, mesh);
    EXPECT_EQ(mesh_sha256(mesh), expected) << "the surface of the frame before is there still";
}

}  // namespace
}  // namespace meniscus
