// The field against a sum over all particles in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "field/kernels.hpp"
#include "neighbors/cpu/particle_field.hpp"
#include "neighbors/cpu/particle_sets.hpp"
#include "steps/cpu_steps.hpp"
#include "support/naive_field.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

void expect_naive_values(const Settings& user, const test::Particles& particles) {
    const LatticeSettings settings(user);
    const auto account = std::make_shared<MemoryAccount>();
    cpu::Workers workers(1);
    cpu::ParticleSets sets(account, workers, settings);
    cpu::State state(account, workers, settings);
    cpu::NeighborSearch near(account, workers.count(), sets);
    std::unique_ptr<cpu::FieldSource> field = with_kernel(settings, [&]<class Kernel>() {
        return std::unique_ptr<cpu::FieldSource>(new cpu::ParticleField<Kernel>(near));
    });
    cpu::register_particles(state, sets, near, particles.frame());
    const test::NaiveField naive(user, particles);

    std::mt19937 random(9);
    std::uniform_int_distribution<int> cell(-3, 11);
    std::uniform_int_distribution<int> unit(0, units_per_base_cell);
    int positive = 0;
    for (int round = 0; round < 60; ++round) {
        const Int3 base{cell(random), cell(random), cell(random)};
        cpu::PointList points;
        for (int i = 0; i < 13; ++i)
            points.add(static_cast<float>(unit(random)), static_cast<float>(unit(random)),
                       static_cast<float>(unit(random)));
        alignas(32) float values[cpu::max_points], gx[cpu::max_points], gy[cpu::max_points], gz[cpu::max_points];
        field->values(base, points, values, 0);
        field->normals(base, points, {gx, gy, gz}, 0);
        const double c = settings.cell_size;
        for (std::size_t i = 0; i < points.count; ++i) {
            const double p[3] = {(base.x * 4 + points.x[i] / 4096.0) * c, (base.y * 4 + points.y[i] / 4096.0) * c,
                                 (base.z * 4 + points.z[i] / 4096.0) * c};
            const double expected = naive.value(p[0], p[1], p[2]);
            ASSERT_NEAR(values[i], expected, 2e-5 * (1 + expected));
            if (expected < 0.05) continue;
            ++positive;
            // The normal's direction against central differences.
            const double e = c / 64;
            const double g[3] = {naive.value(p[0] + e, p[1], p[2]) - naive.value(p[0] - e, p[1], p[2]),
                                 naive.value(p[0], p[1] + e, p[2]) - naive.value(p[0], p[1] - e, p[2]),
                                 naive.value(p[0], p[1], p[2] + e) - naive.value(p[0], p[1], p[2] - e)};
            const double size = std::hypot(g[0], g[1], g[2]);
            if (size / (2 * e) * c < 0.02) continue;
            const double got = std::hypot(double{gx[i]}, double{gy[i]}, double{gz[i]});
            EXPECT_NEAR(got, 1.0, 1e-5);
            EXPECT_LT((g[0] * gx[i] + g[1] * gy[i] + g[2] * gz[i]) / (size * got), -0.9995);
        }
    }
    EXPECT_GT(positive, 100);
}

TEST(Field, DensityIsTheSumOverAllParticles) {
    Settings settings = test::default_settings();
    settings.field = Field::density;
    expect_naive_values(settings, test::splash(21, 10));
}

TEST(Field, SmoothIsTheSumOverAllParticlesByTheirCompany) {
    Settings settings = test::default_settings();
    for (const std::uint32_t smoothness : {5U, 6U, 7U}) {
        settings.smoothness = smoothness;
        for (const double iso : {0.6, 0.8}) {
            settings.iso = iso;
            expect_naive_values(settings, test::splash(24, 10));
        }
    }
}

TEST(Field, ColorIsTheSumOverAllParticlesDividedByTheirDensity) {
    Settings settings = test::default_settings();
    settings.field = Field::color;
    expect_naive_values(settings, test::splash(22, 10));
}

TEST(Field, ParticleLevelsScaleRadiusSupportAndMass) {
    test::Particles particles = test::splash(23, 8);
    for (std::size_t i = 0; i < particles.count(); ++i)
        particles.levels.push_back(static_cast<std::uint8_t>(i % 11 == 0 ? 3 : i % 4));
    for (const Field field : {Field::density, Field::color, Field::smooth}) {
        Settings settings = test::default_settings();
        settings.field = field;
        expect_naive_values(settings, particles);
    }
}

template <class Kernel>
void expect_bits_of_one_float(const Kernel& kernel, const float (&x)[8], const float (&y)[8], const float (&z)[8]) {
    alignas(32) float values[8], gradients[8], hessians[8];
    const Lanes<8> lx = Lanes<8>::load(x), ly = Lanes<8>::load(y), lz = Lanes<8>::load(z);
    kernel.add_value(Lanes<8>(0.25F), lx, ly, lz).store(values);
    Lanes<8> gx(0.0F), gy(0.0F), gz(0.0F);
    kernel.add_gradient(gx, gy, gz, lx, ly, lz);
    gy.store(gradients);
    FieldJet<Lanes<8>> jets;
    kernel.add_jet(jets, lx, ly, lz);
    jets.xz.store(hessians);
    for (int i = 0; i < 8; ++i) {
        ASSERT_EQ(values[i], kernel.add_value(0.25F, x[i], y[i], z[i]));
        float sx = 0.0F, sy = 0.0F, sz = 0.0F;
        kernel.add_gradient(sx, sy, sz, x[i], y[i], z[i]);
        ASSERT_EQ(gradients[i], sy);
        FieldJet<float> jet;
        kernel.add_jet(jet, x[i], y[i], z[i]);
        ASSERT_EQ(hessians[i], jet.xz);
    }
}

TEST(Field, EightLanesGiveTheBitsOfOneFloat) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> distance(-40000.0F, 40000.0F);
    for (int round = 0; round < 2000; ++round) {
        alignas(32) float x[8], y[8], z[8];
        for (int i = 0; i < 8; ++i) {
            x[i] = std::round(distance(random));
            y[i] = std::round(distance(random));
            z[i] = std::round(distance(random));
        }
        expect_bits_of_one_float(CubicSpline{0.318F, 1.0F / 32768.0F}, x, y, z);
        expect_bits_of_one_float(Poly6{0.68F, Poly6::fall_of(0.68F, 32768.0F)}, x, y, z);
    }
}

TEST(Field, TheKernelIntegratesToOne) {
    double integral = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double q = (i + 0.5) / steps;
        integral += 4 * std::numbers::pi * q * q / steps * static_cast<double>(cubic_spline(static_cast<float>(q))) *
                    16 / std::numbers::pi;
    }
    EXPECT_NEAR(integral, 1.0, 1e-5);
}

TEST(Field, AJetIsTheValueAndItsDerivatives) {
    const auto expect_derivatives = [](const auto& kernel, float h) {
        const float x = 0.31F * h, y = -0.42F * h, z = 0.23F * h, e = h / 256;
        FieldJet<float> jet, above, below;
        kernel.add_jet(jet, x, y, z);
        kernel.add_jet(above, x, y + e, z);
        kernel.add_jet(below, x, y - e, z);
        EXPECT_FLOAT_EQ(jet.value, kernel.add_value(0.0F, x, y, z));
        EXPECT_NEAR(jet.y, (above.value - below.value) / (2 * e), 1e-3 * std::abs(jet.y));
        EXPECT_NEAR(jet.xy, (above.x - below.x) / (2 * e), 1e-2 * std::abs(jet.xy));
        EXPECT_NEAR(jet.yy, (above.y - below.y) / (2 * e), 1e-2 * std::abs(jet.yy));
        EXPECT_NEAR(jet.yz, (above.z - below.z) / (2 * e), 1e-2 * std::abs(jet.yz));
        float gx = 0.0F, gy = 0.0F, gz = 0.0F;
        kernel.add_gradient(gx, gy, gz, x, y, z);
        EXPECT_NEAR(gx / gy, jet.x / jet.y, 1e-4);
        EXPECT_NEAR(gz / gy, jet.z / jet.y, 1e-4);
    };
    expect_derivatives(CubicSpline{0.318F, 1.0F / 32768.0F}, 32768.0F);
    expect_derivatives(Poly6{0.68F, Poly6::fall_of(0.68F, 32768.0F)}, 32768.0F);
}

TEST(Field, ASmoothShareEndsExactlyAtItsSupport) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> supports(1.0F, 1048576.0F), weights(0.01F, 2.0F);
    for (int round = 0; round < 20000; ++round) {
        const float support = supports(random), weight = weights(random);
        const Poly6 kernel{weight, Poly6::fall_of(weight, support)};
        const float at = std::ceil(support);
        ASSERT_EQ(kernel.add_value(0.0F, at, 0.0F, 0.0F), 0.0F) << support;
        ASSERT_EQ(kernel.add_value(0.0F, 0.0F, at, 1.0F), 0.0F) << support;
        ASSERT_GT(kernel.add_value(0.0F, 0.0F, 0.0F, 0.99F * support), 0.0F);
        ASSERT_NEAR(kernel.support(), support, 4e-6F * support);
    }
}

TEST(Field, CubeRootsAreThose) {
    for (int i = 0; i < 440; ++i) {
        const double x = 1e-30 * std::pow(1.37, i);  // up to 1e30
        ASSERT_NEAR(cube_root(static_cast<float>(x)) / std::cbrt(x), 1.0, 4e-7) << x;
    }
}

}  // namespace
}  // namespace meniscus
