// Several processes with some of the particles each, as threads: whatever each has, and however parts are dealt to
// them, all parts together give the whole's mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <mutex>
#include <stdexcept>

#include "support/parts.hpp"
#include "support/refusal.hpp"
#include "support/thread_exchange.hpp"

namespace meniscus {
namespace {

/// rank_of(particle)
void expect_the_whole_of_processes(const Settings& settings, test::ParticlesWithArrays& all, std::size_t ranks,
                                   std::size_t parts, const std::function<std::size_t(std::size_t)>& rank_of) {
    std::vector<test::ParticlesWithArrays> of_rank(ranks);
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        of_rank[rank].names = all.names;
        of_rank[rank].arrays = all.arrays;
        of_rank[rank].bytes.resize(all.bytes.size());
    }
    for (std::size_t i = 0; i < all.particles.count(); ++i) {
        test::ParticlesWithArrays& its = of_rank[rank_of(i)];
        its.particles.add(all.particles.positions[3 * i], all.particles.positions[3 * i + 1],
                          all.particles.positions[3 * i + 2]);
        for (std::size_t a = 0; a < all.bytes.size(); ++a) {
            const std::size_t size = all.arrays[a].element_bytes();
            const auto from = all.bytes[a].begin() + static_cast<std::ptrdiff_t>(i * size);
            its.bytes[a].insert(its.bytes[a].end(), from, from + static_cast<std::ptrdiff_t>(size));
        }
    }
    std::mutex mutex;
    test::FrameOfParts result;
    std::vector<PartsReport> reports(ranks);
    test::on_ranks(ranks, [&](test::ThreadExchange& exchange) {
        PartsReconstructor reconstructor(settings, {Backend::cpu, 1, 0}, {.parts = parts}, exchange);
        const PartSink sink = result.sink();
        reports[exchange.rank()] =
            reconstructor.reconstruct(of_rank[exchange.rank()].frame(), [&](const FinishedPart& part) {
                const std::lock_guard lock(mutex);
                sink(part);
            });
    });
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh whole;
    reconstructor.reconstruct(all.frame(), whole);
    test::expect_same_mesh(result.whole(), whole);
    for (const PartsReport& report : reports) {
        EXPECT_EQ(report.whole.particles, all.particles.count());
        EXPECT_EQ(report.whole.volume, reconstructor.statistics().volume);
        EXPECT_EQ(report.whole.vertices, whole.vertices.size());
        EXPECT_EQ(report.parts_made, reports[0].parts_made);
    }
}

TEST(Processes, GiveTheWholesMeshHoweverParticlesAreDealt) {
    test::ParticlesWithArrays all = test::with_noise(test::splash(61, 12), 61);
    Settings settings = test::default_settings();
    settings.cell_size = 0.25;
    settings.all_attributes = true;
    std::mt19937 random(61);
    for (const std::size_t ranks : {2U, 3U, 5U}) {
        SCOPED_TRACE(ranks);
        expect_the_whole_of_processes(settings, all, ranks, ranks, [&](std::size_t) { return random() % ranks; });
        expect_the_whole_of_processes(settings, all, ranks, ranks, [&](std::size_t) { return ranks - 1; });
        expect_the_whole_of_processes(settings, all, ranks, ranks,
                                      [&](std::size_t i) { return i * ranks / all.particles.count(); });
        expect_the_whole_of_processes(settings, all, ranks, 2 * ranks + 1,
                                      [&](std::size_t) { return random() % ranks; });
    }
}

TEST(Processes, ChooseTheSameAttributesWhicheverHadParticlesFirst) {
    Settings settings = test::default_settings();
    settings.all_attributes = true;
    const auto age = [](std::size_t i, std::size_t) { return static_cast<float>(i); };
    std::vector<test::ParticlesWithArrays> of_rank(2);
    std::mutex mutex;
    std::vector<test::FrameOfParts> results(2);
    test::Barrier between(of_rank.size());
    test::on_ranks(of_rank.size(), [&](test::ThreadExchange& exchange) {
        const std::size_t rank = exchange.rank();
        test::ParticlesWithArrays& mine = of_rank[rank];
        PartsReconstructor reconstructor(settings, {Backend::cpu, 1, 0}, {.parts = 2}, exchange);
        for (std::size_t frame = 0; frame < results.size(); ++frame) {
            if (rank == frame) mine.particles = test::splash(63, 8);
            if (rank == 0 || frame == 1) {
                mine = {.particles = mine.particles, .names = {}, .arrays = {}, .bytes = {}};
                mine.add_floats("age", 1, age);
                if (frame == 1) mine.add_floats("pressure", 1, age);
            }
            const PartSink sink = results[frame].sink();
            EXPECT_NO_THROW(reconstructor.reconstruct(mine.frame(), [&](const FinishedPart& part) {
                const std::lock_guard lock(mutex);
                sink(part);
            }));
            between.arrive_and_wait();
        }
    });
    for (const test::FrameOfParts& result : results) {
        const Mesh whole = result.whole();
        ASSERT_EQ(whole.attributes.size(), 1U);
        EXPECT_EQ(whole.attributes[0].name, "age");
        EXPECT_FALSE(whole.triangles.empty());
    }
}

TEST(Processes, AllThrowWhatOneOfThemMeetsAndGoOn) {
    const test::Particles good = test::splash(64, 6);
    test::Particles bad = good;
    bad.positions[7] = NAN;
    test::on_ranks(3, [&](test::ThreadExchange& exchange) {
        PartsReconstructor reconstructor(test::default_settings(), {Backend::cpu, 1, 0}, {.parts = 3}, exchange);
        const PartSink pass = [](const FinishedPart&) {};
        const auto rank = exchange.rank();
        const test::Particles none;
        EXPECT_EQ(
            test::refusal([&] { reconstructor.reconstruct((rank == 1 ? bad : none).frame(), pass); }).substr(0, 20),
            "rank 1: particle 2 h");
        EXPECT_EQ(test::refusal<ProcessFailed>([&] {
                      reconstructor.reconstruct((rank == 0 ? good : none).frame(), [&](const FinishedPart&) {
                          if (rank == 2) throw std::runtime_error("no room for the mesh");
                      });
                  }),
                  "rank 2: no room for the mesh");
        EXPECT_EQ(reconstructor.reconstruct((rank == 0 ? good : none).frame(), pass).whole.particles, good.count());
    });
}

TEST(Processes, MendNoiseTogether) {
    test::ParticlesWithArrays all;
    all.particles = test::noise_cube(62, 6000, 0.5, 0.025);
    std::mt19937 random(62);
    expect_the_whole_of_processes(test::default_settings(), all, 4, 4, [&](std::size_t) { return random() % 4; });
}

}  // namespace
}  // namespace meniscus
