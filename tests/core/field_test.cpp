// The field against a sum over all particles in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "engine/cpu/particle_field.hpp"
#include "field/kernel.hpp"
#include "particles/particle_sets.hpp"
#include "steps/cpu_steps.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

double spline(double distance, double h) {
    const double q = distance / h;
    const double a = std::max(1 - q, 0.0), b = std::max(0.5 - q, 0.0);
    return 8 / (std::numbers::pi * h * h * h) * (2 * a * a * a - 8 * b * b * b);
}

/// All particles, in double: what the field is by definition.
class NaiveField {
public:
    NaiveField(const Settings& s, const test::Particles& particles) : settings_(s), particles_(particles) {
        weights_.assign(particles.count(), 0.0);
        for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = std::pow(2 * radius(i), 3);
        if (s.field == Field::color) {
            std::vector<double> density(weights_.size());
            for (std::size_t i = 0; i < weights_.size(); ++i) {
                const auto p = position(i);
                density[i] = value(p[0], p[1], p[2]);
            }
            for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] /= density[i];
        }
    }
    double value(double x, double y, double z) const {
        double sum = 0;
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const auto p = position(i);
            sum += weights_[i] *
                   spline(std::hypot(x - p[0], y - p[1], z - p[2]), support(settings_) * radius(i));
        }
        return sum;
    }

private:
    double radius(std::size_t i) const {
        return settings_.particle_radius * (particles_.levels.empty() ? 1 : 1 << particles_.levels[i]);
    }
    /// Snapped as the lattice has it.
    std::array<double, 3> position(std::size_t i) const {
        const double unit = world_cell_size(settings_) / 4096;
        return {std::nearbyint(particles_.positions[3 * i] / unit) * unit,
                std::nearbyint(particles_.positions[3 * i + 1] / unit) * unit,
                std::nearbyint(particles_.positions[3 * i + 2] / unit) * unit};
    }
    Settings settings_;
    const test::Particles& particles_;
    std::vector<double> weights_;
};

void expect_naive_values(const Settings& user, const test::Particles& particles) {
    const LatticeSettings settings(user);
    const auto account = std::make_shared<MemoryAccount>();
    cpu::Workers workers(1);
    cpu::ParticleSets sets(account, workers, settings);
    cpu::State state(account, workers, settings);
    cpu::Neighborhoods near(account, workers.count(), sets);
    cpu::ParticleField field(near);
    cpu::register_particles(state, sets, near, particles.frame());
    const NaiveField naive(user, particles);

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
        field.values(base, points, values, 0);
        field.normals(base, points, gx, gy, gz, 0);
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

TEST(Field, ColorIsTheSumOverAllParticlesDividedByTheirDensity) {
    expect_naive_values(test::default_settings(), test::splash(22, 10));
}

TEST(Field, ParticleLevelsScaleRadiusSupportAndMass) {
    test::Particles particles = test::splash(23, 8);
    for (std::size_t i = 0; i < particles.count(); ++i)
        particles.levels.push_back(static_cast<std::uint8_t>(i % 11 == 0 ? 3 : i % 4));
    for (const Field field : {Field::density, Field::color}) {
        Settings settings = test::default_settings();
        settings.field = field;
        expect_naive_values(settings, particles);
    }
}

TEST(Field, EightLanesGiveTheBitsOfOneFloat) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> distance(-40000.0F, 40000.0F);
    for (int round = 0; round < 2000; ++round) {
        alignas(32) float x[8], y[8], z[8], lanes[8], gradient[8];
        for (int i = 0; i < 8; ++i) {
            x[i] = std::round(distance(random));
            y[i] = std::round(distance(random));
            z[i] = std::round(distance(random));
        }
        const Lanes sum =
            add_value(Lanes(0.25F), Lanes::load(x), Lanes::load(y), Lanes::load(z), 0.318F, 1.0F / 32768.0F);
        sum.store(lanes);
        Lanes gx(0.0F), gy(0.0F), gz(0.0F);
        add_gradient(gx, gy, gz, Lanes::load(x), Lanes::load(y), Lanes::load(z), 0.318F, 1.0F / 32768.0F);
        gy.store(gradient);
        for (int i = 0; i < 8; ++i) {
            ASSERT_EQ(lanes[i], add_value(0.25F, x[i], y[i], z[i], 0.318F, 1.0F / 32768.0F));
            float sx = 0.0F, sy = 0.0F, sz = 0.0F;
            add_gradient(sx, sy, sz, x[i], y[i], z[i], 0.318F, 1.0F / 32768.0F);
            ASSERT_EQ(gradient[i], sy);
        }
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

}  // namespace
}  // namespace meniscus
