// The interpreter of PTX computes what PTX says, and counts what a warp does: on small kernels by hand.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "model/price.hpp"
#include "model/ptx_grid.hpp"

namespace meniscus::benchmarks {
namespace {

const std::filesystem::path tables = std::filesystem::path(MENISCUS_SOURCE_DIR) / "tests/benchmarks/model";

/// A kernel of one parameter, a pointer in %rd1, and what is done with it. %r1 is the thread, %rd2 the place of its
/// word.
PtxProgram program(const std::string& body, const std::string& variables = {}) {
    const std::string text =
        ".version 9.0\n.target sm_90\n// a comment with a ; in it\n.entry test(\n\t.param .u64 test_param_0\n)\n{\n" +
        variables +
        "ld.param.u64 %rd1, [test_param_0];\nmov.u32 %r1, %tid.x;\n"
        "mul.wide.u32 %rd3, %r1, 4;\nadd.s64 %rd2, %rd1, %rd3;\n" +
        body + "ret;\n}\n";
    std::vector<PtxKernel> kernels = read_ptx(text);
    EXPECT_EQ(kernels.size(), 1U);
    return {std::move(kernels.at(0)), InstructionCosts::read(tables / "instructions.csv")};
}

constexpr std::size_t beginning = 4;  ///< instructions in front of the body

template <std::size_t n>
LaunchCounts run(PtxProgram& program, std::array<std::uint32_t, n>& words, const PtxLaunch& launch = {1, 32}) {
    std::uint32_t* pointer = words.data();
    void* const parameters[] = {&pointer};
    return program.run(launch, parameters, GpuConstants::read(tables / "gpus.csv", "H200"));
}

std::array<std::uint32_t, 32> run_on_a_warp(const std::string& body) {
    std::array<std::uint32_t, 32> words{};
    std::iota(words.begin(), words.end(), 0U);
    PtxProgram kernel = program(body);
    run(kernel, words);
    return words;
}

TEST(Ptx, ComputesWithEveryLanesOwnValues) {
    const auto words = run_on_a_warp(
        "mad.lo.s32 %r2, %r1, %r1, -7;\nshl.b32 %r3, %r2, 1;\nxor.b32 %r4, %r3, 0x10;\nst.global.u32 [%rd2], %r4;\n");
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words[i], ((i * i - 7) << 1 ^ 0x10)) << i;
}

TEST(Ptx, ExtendsTheSignOfWhatItLoads) {
    const auto words = run_on_a_warp(
        "sub.s32 %r2, 3, %r1;\nst.global.u32 [%rd2], %r2;\nld.global.s32 %rd4, [%rd2];\nshr.s64 %rd5, %rd4, 32;\n"
        "ld.global.s8 %r3, [%rd2];\nadd.s32 %r3, %r3, 1000;\ncvt.u32.u64 %r4, %rd5;\nadd.s32 %r5, %r3, %r4;\n"
        "st.global.u32 [%rd2], %r5;\n");
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words[i], 1003 - i - (i > 3 ? 1 : 0)) << i;
}

TEST(Ptx, RoundsAsTheHostDoes) {
    const auto words = run_on_a_warp(
        "cvt.rn.f32.u32 %f1, %r1;\nfma.rn.f32 %f2, %f1, 0f3DCCCCCD, 0f3F800000;\nsqrt.rn.f32 %f3, %f2;\n"
        "div.rn.f32 %f4, %f3, 0f40400000;\nst.global.f32 [%rd2], %f4;\n");
    for (std::uint32_t i = 0; i < 32; ++i) {
        const float expected = std::sqrt(std::fma(static_cast<float>(i), 0.1F, 1.0F)) / 3.0F;
        EXPECT_EQ(words[i], std::bit_cast<std::uint32_t>(expected)) << i;
    }
}

TEST(Ptx, TakesApartLanesThatPartAndMeetAgain) {
    PtxProgram kernel = program(
        "setp.lt.u32 %p1, %r1, 8;\n"
        "@%p1 bra $low;\n"
        "mov.u32 %r2, 100;\n"  // 24 lanes
        "bra.uni $end;\n"
        "$low:\n"
        "mov.u32 %r2, 200;\n"  // 8 lanes
        "$end:\n"
        "st.global.u32 [%rd2], %r2;\n");
    std::array<std::uint32_t, 32> words{};
    const LaunchCounts counts = run(kernel, words);
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words[i], i < 8 ? 200 : 100) << i;
    // Each instruction once: both ways one after the other, the last one by all lanes together.
    for (const std::uint64_t n : kernel.executed()) EXPECT_EQ(n, 1U);
    EXPECT_EQ(counts.ptx, static_cast<double>(beginning + 7));
    // One lane's worth less where only a part goes; a branch counts the lanes that take it.
    EXPECT_EQ(counts.lanes, 32.0 * static_cast<double>(beginning + 3) + 8 + 24 + 24 + 8);
}

TEST(Ptx, CountsALoopAsOftenAsItsLongestLane) {
    PtxProgram kernel = program(
        "mov.u32 %r2, 0;\n"
        "$again:\n"
        "add.s32 %r2, %r2, 1;\n"
        "setp.le.u32 %p1, %r2, %r1;\n"
        "@%p1 bra $again;\n"
        "st.global.u32 [%rd2], %r2;\n");
    std::array<std::uint32_t, 32> words{};
    run(kernel, words);
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words[i], i + 1);
    EXPECT_EQ(kernel.executed()[beginning + 1], 32U);
    EXPECT_EQ(kernel.executed()[beginning + 4], 1U) << "the lanes have met again behind the loop";
}

TEST(Ptx, ShufflesAndVotesAcrossLanesThatCameByDifferentWays) {
    const auto words = run_on_a_warp(
        "and.b32 %r2, %r1, 1;\nsetp.eq.s32 %p1, %r2, 0;\n@%p1 bra $even;\nadd.s32 %r1, %r1, 0;\n$even:\n"
        "shfl.sync.up.b32 %r3|%p2, %r1, 3, 0, -1;\n"
        "shfl.sync.bfly.b32 %r4|%p3, %r1, 16, 31, -1;\n"
        "shfl.sync.idx.b32 %r5|%p4, %r1, 5, 31, -1;\n"
        "vote.sync.ballot.b32 %r6, %p1, -1;\n"
        "mad.lo.s32 %r7, %r4, 100, %r3;\nmad.lo.s32 %r7, %r5, 10000, %r7;\n"
        "setp.eq.s32 %p5, %r6, 0x55555555;\n@!%p5 bra $end;\nst.global.u32 [%rd2], %r7;\n$end:\n");
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words[i], 50000 + 100 * (i ^ 16) + (i < 3 ? i : i - 3)) << i;
}

TEST(Ptx, WaitsForTheBlockAndForTheGrid) {
    // Each thread reads in shared memory what its neighbor has written, then all wait for the grid and read what the
    // last block has written.
    PtxProgram kernel = program(
        "mov.u32 %r2, %ctaid.x;\n"
        "shl.b32 %r3, %r1, 2;\nmov.u32 %r4, words;\nadd.s32 %r4, %r4, %r3;\n"
        "add.s32 %r5, %r1, 1000;\nst.shared.u32 [%r4], %r5;\n"
        "bar.sync 0;\n"
        "xor.b32 %r6, %r3, 128;\nmov.u32 %r7, words;\nadd.s32 %r7, %r7, %r6;\nld.shared.u32 %r8, [%r7];\n"
        // The grid's barrier, as cooperative_groups has it.
        "mov.u32 %r20, %envreg2;\nmov.u32 %r21, %envreg1;\ncvt.u64.u32 %rd20, %r20;\ncvt.u64.u32 %rd21, %r21;\n"
        "bfi.b64 %rd22, %rd21, %rd20, 32, 32;\nadd.s64 %rd23, %rd22, 4;\n"
        "barrier.sync 0;\nsetp.ne.s32 %p1, %r1, 0;\n@%p1 bra $passed;\n"
        "setp.eq.s32 %p2, %r2, 0;\nselp.b32 %r22, 2147483645, 1, %p2;\n"  // 0x80000000 less the other three blocks
        "atom.add.release.gpu.u32 %r23, [%rd23], %r22;\n"
        "$wait:\nld.acquire.gpu.u32 %r24, [%rd23];\nxor.b32 %r25, %r24, %r23;\nsetp.gt.s32 %p3, %r25, -1;\n"
        "@%p3 bra $wait;\n$passed:\nbarrier.sync 0;\n"
        "mad.lo.s32 %r9, %r2, 64, %r1;\nmul.wide.u32 %rd4, %r9, 4;\nadd.s64 %rd5, %rd1, %rd4;\n"
        "st.global.u32 [%rd5], %r8;\n",
        ".shared .align 4 .b8 words[256];\n");
    std::array<std::uint32_t, 256> words{};
    const LaunchCounts counts = run(kernel, words, {4, 64, true, 1});
    for (std::uint32_t i = 0; i < 256; ++i) EXPECT_EQ(words[i], 1000 + (i % 64 ^ 32)) << i;
    EXPECT_EQ(counts.grid_barriers, 1.0);
    EXPECT_EQ(counts.warps, 8U);
}

TEST(Ptx, CountsWhatWarpsAskOfMemory) {
    // 32 neighboring words are 4 sectors in one line; a stride of 128 bytes asks for a line a lane.
    std::array<std::uint32_t, 2048> words{};
    const auto aligned = [&] {
        const auto at = reinterpret_cast<std::uint64_t>(words.data());
        return at % 128 == 0;
    };
    PtxProgram neighbors =
        program("ld.global.u32 %r2, [%rd2];\nld.global.u32 %r3, [%rd2];\nst.global.u32 [%rd2], %r2;\n");
    const LaunchCounts near = run(neighbors, words);
    const double sectors = aligned() ? 4.0 : near.own_sectors;
    EXPECT_LE(near.own_sectors, 5.0);
    EXPECT_EQ(near.sectors, 3.0 * sectors);
    EXPECT_EQ(near.missed_sectors, 2.0 * sectors) << "the second load hits, and a store goes on to the second cache";
    PtxProgram strided =
        program("mul.wide.u32 %rd4, %r1, 128;\nadd.s64 %rd5, %rd1, %rd4;\nld.global.u32 %r2, [%rd5];\n");
    EXPECT_EQ(run(strided, words).own_sectors, 32.0);
}

TEST(Ptx, RefusesWhatItDoesNotKnowAndTellsLocks) {
    EXPECT_THROW(program("wgmma.fence.sync.aligned;\n"), std::runtime_error);
    EXPECT_THROW(run_on_a_warp("trap;\n"), std::runtime_error);
    EXPECT_THROW(
        run_on_a_warp("$again:\nld.acquire.gpu.u32 %r2, [%rd1];\nsetp.eq.s32 %p1, %r2, 0;\n@%p1 bra $again;\n"),
        std::runtime_error);
    // Half of the lanes wait for all of them, and the others have ended.
    EXPECT_THROW(run_on_a_warp("setp.lt.u32 %p1, %r1, 16;\n@%p1 bra $end;\nbar.warp.sync -1;\n$end:\n"),
                 std::runtime_error);
}

TEST(Price, IsTheSlowestOfWhatALaunchNeeds) {
    const GpuConstants gpu = GpuConstants::read(tables / "gpus.csv", "H200");
    const KernelResources kernel{64, 0, 100.0};
    EXPECT_EQ(blocks_of_processor(kernel, 256, gpu), 4U);
    EXPECT_EQ(blocks_of_processor({33, 0, 0.0}, 256, gpu), 6U) << "registers are given out by 256 a warp";
    EXPECT_EQ(blocks_of_processor({16, 100'000, 0.0}, 256, gpu), 2U);
    LaunchCounts counts;
    counts.warps = 132 * 32;
    counts.issued = 4.0 * 132 * 1900;  // one microsecond
    Price price = price_launch(counts, 1.0, kernel, 100.0, 256, gpu);
    EXPECT_NEAR(price.total(), 1.0, 1e-9);
    EXPECT_EQ(price.bound(), "issue");
    EXPECT_NEAR(price_launch(counts, 1.0, kernel, 50.0, 256, gpu).total(), 2.0, 1e-9) << "twice as long as compiled";
    counts.own_sectors = 4300e3 * 3 / 32;
    counts.grid_barriers = 2.0;
    price = price_launch(counts, 1.0, kernel, 100.0, 256, gpu);
    EXPECT_EQ(price.bound(), "device memory");
    EXPECT_NEAR(price.total(), 3.0 + 2.0 * gpu["grid_barrier_us"], 1e-9);
    EXPECT_THROW(GpuConstants::read(tables / "gpus.csv", "Abacus"), std::exception);
}

}  // namespace
}  // namespace meniscus::benchmarks
