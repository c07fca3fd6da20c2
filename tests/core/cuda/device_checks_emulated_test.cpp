// The checks of the device in software: kernels that break the rules of a GPU or of CUB do not pass.
#include <cooperative_groups.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <type_traits>
#include <vector>

#include "engine/cuda/launch.hpp"
#include "engine/cuda/scans.hpp"
#include "engine/cuda/stream.hpp"
#include "engine/cuda/warp.hpp"
#include "meniscus/error.hpp"
#include "neighbors/cuda/cell_cluster.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

template <class... Parameters>
void run(unsigned blocks, void (*kernel)(Parameters...), const std::type_identity_t<Parameters>&... arguments) {
    cuda::Stream stream;
    cuda::Launcher{stream.get(), blocks}(blocks * cuda::block_threads, cuda::block_threads, kernel, arguments...);
    stream.synchronize();
}
template <class... Parameters>
void run_together(unsigned blocks, void (*kernel)(Parameters...),
                  const std::type_identity_t<Parameters>&... arguments) {
    cuda::Stream stream;
    cuda::Launcher{stream.get(), blocks}.cooperative(blocks * cuda::block_threads, kernel, arguments...);
    stream.synchronize();
}

/// The last cluster of the last brick that there may be: all clusters together are more than 2^32.
void find_the_last_cluster(const cuda::State* state, std::uint32_t* brick, int* corner) {
    using Cluster = cuda::CellCluster<4, 2, 2>;
    const Cluster cluster(*state, Cluster::of_brick * cuda::too_many(cuda::Resource::bricks) - 1);
    *brick = cluster.brick;
    *corner = index_in_brick(cluster.corner);
}
/// A loop over more elements than 32 bits can count, from the last few on.
void count_the_last_of_many(unsigned long long* sum) {
    constexpr std::uint64_t many = (std::uint64_t{1} << 32) + 2;
    cuda::GridLoop loop;
    loop.first += std::uint64_t{1} << 32;
    loop.each<std::uint64_t>(many, [&](std::uint64_t i) { atomicAdd(sum, static_cast<unsigned long long>(i)); });
}

void name_too_few_lanes(unsigned* out) {
    out[threadIdx.x] = __ballot_sync(0x7FFFFFFF, 1);
}
void name_other_lanes(unsigned* out) {
    const unsigned mask = threadIdx.x == 3 ? 0x7FFFFFFF : cuda::all_lanes;
    out[threadIdx.x] = __ballot_sync(mask, 1);
}
void meet_by_different_calls(unsigned* out) {
    // clang-format off
    out[threadIdx.x] = threadIdx.x % 2 == 0 ? __ballot_sync(cuda::all_lanes, 1) : __shfl_sync(cuda::all_lanes, 1U, 0);
    // clang-format on
}
void meet_by_equal_calls_in_one_line(unsigned* out) {
    // clang-format off
    out[threadIdx.x] = threadIdx.x % 2 == 0 ? __ballot_sync(cuda::all_lanes, 1) : __ballot_sync(cuda::all_lanes, 0);
    // clang-format on
}
void wait_for_the_block_at_different_places() {
    if (threadIdx.x % 2 == 0)  // NOLINT(bugprone-branch-clone): the same call at two places is what is wrong here
        __syncthreads();
    else
        __syncthreads();
}
void leave_before_the_block_waits() {
    if (threadIdx.x == 7) return;
    __syncthreads();
}

TEST(LoopsEmulated, CountBeyond32Bits) {
    unsigned long long sum = 0;
    run(1, count_the_last_of_many, &sum);
    EXPECT_EQ(sum, (1ULL << 33) + 1);
    // Memory that is only asked for where the last brick lies.
    const std::size_t bytes = cuda::too_many(cuda::Resource::bricks) * sizeof(Brick);
    void* const bricks =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (bricks == MAP_FAILED) GTEST_SKIP() << "this host gives out no address space that it may lack memory for";
    cuda::State state{LatticeSettings(test::default_settings())};
    state.bricks = static_cast<Brick*>(bricks);
    const auto last = static_cast<std::uint32_t>(cuda::too_many(cuda::Resource::bricks) - 1);
    std::uint32_t brick = 0;
    int corner = 0;
    run(1, find_the_last_cluster, &state, &brick, &corner);
    munmap(bricks, bytes);
    EXPECT_EQ(brick, last);
    EXPECT_EQ(corner, index_in_brick({12, 14, 14}));
}

TEST(DeviceChecksEmulated, MasksNameTheLanesThatCome) {
    std::vector<unsigned> out(cuda::block_threads);
    EXPECT_DEATH(run(1, name_too_few_lanes, out.data()), "a lane is not in its own mask: __ballot_sync");
    EXPECT_DEATH(run(1, name_other_lanes, out.data()), "threads meet at different places: .*7FFFFFFF");
}

TEST(DeviceChecksEmulated, DifferentMeetingsAreToldApart) {
    std::vector<unsigned> out(cuda::block_threads);
    EXPECT_DEATH(run(1, meet_by_different_calls, out.data()),
                 "__ballot_sync .*__shfl_sync|__shfl_sync .*__ballot_sync");
    EXPECT_DEATH(run(1, meet_by_equal_calls_in_one_line, out.data()), "threads meet at different places");
    EXPECT_DEATH(run(1, wait_for_the_block_at_different_places), "__syncthreads in line .* and __syncthreads in line");
}

TEST(DeviceChecksEmulated, AThreadThatDoesNotComeIsMissed) {
    EXPECT_DEATH(run(1, leave_before_the_block_waits), "threads wait for some that do not come");
}

/// Quarters of a warp meet different numbers of times, then all lanes do.
void meet_in_quarters(unsigned* out) {
    const unsigned lane = cuda::lane_index();
    const unsigned first = lane & ~7U;
    unsigned sum = 0;
    for (unsigned i = 0; i <= lane / 8; ++i)
        sum += __shfl_sync(0xFFU << first, lane + 100 * i, static_cast<int>(first + i));
    out[threadIdx.x] = sum + __shfl_sync(cuda::all_lanes, sum, 31);
}
void meet_in_other_parts(unsigned* out) {
    const unsigned first = cuda::lane_index() & ~7U;
    out[threadIdx.x] = __shfl_sync(0xFFU << first, 0U, static_cast<int>(first));
    const unsigned half = cuda::lane_index() & ~15U;
    out[threadIdx.x] += __shfl_sync(0xFFFFU << half, 0U, static_cast<int>(half));
}

TEST(DeviceChecksEmulated, PartsOfAWarpMeetOnTheirOwn) {
    std::vector<unsigned> out(cuda::block_threads);
    run(1, meet_in_quarters, out.data());
    const auto of_quarter = [](unsigned quarter) {
        unsigned sum = 0;
        for (unsigned i = 0; i <= quarter; ++i) sum += 8 * quarter + i + 100 * i;
        return sum;
    };
    for (unsigned t = 0; t < cuda::block_threads; ++t)
        EXPECT_EQ(out[t], of_quarter(t % 32 / 8) + of_quarter(3)) << "thread " << t;
    EXPECT_DEATH(run(1, meet_in_other_parts, out.data()), "threads meet at different places");
}

void read_shared_memory(unsigned* out) {
    auto& word = emulated_device::shared<unsigned>();
    if (threadIdx.x == 0) out[blockIdx.x] = word;
    __syncthreads();
    word = 0;
}
void overrun_shared_memory() {
    unsigned* const words = emulated_device::shared<unsigned[32]>();
    words[(threadIdx.x < 32 ? 0 : 1) + cuda::lane_index()] = 1;
}

TEST(DeviceChecksEmulated, SharedMemoryIsRubbishWhenABlockBegins) {
    std::vector<unsigned> out(8, 0);
    run(8, read_shared_memory, out.data());
    EXPECT_EQ(out, std::vector<unsigned>(8, 0xA5A5A5A5));
}

TEST(DeviceChecksEmulated, AnOverrunOfSharedMemoryIsFound) {
    EXPECT_DEATH(run(1, overrun_shared_memory), "shared memory was overrun: the variable of 128 bytes");
}

void note_order(unsigned* noted, unsigned* count) {
    if (threadIdx.x == 0) noted[atomicAdd(count, 1U)] = blockIdx.x;
}
/// Each block's first thread notes the value that the next block's has written before the grid waited.
void pass_on(unsigned* written, unsigned* read, bool waits) {
    if (threadIdx.x == 0) written[blockIdx.x] = blockIdx.x + 1;
    if (waits) cooperative_groups::this_grid().sync();
    if (threadIdx.x == 0) read[blockIdx.x] = written[(blockIdx.x + 1) % gridDim.x];
}
void wait_for_the_grid() {
    cooperative_groups::this_grid().sync();
}

TEST(DeviceChecksEmulated, BlocksBeginInAnOrderOfChance) {
    const auto order_of_seed = [](unsigned seed) {
        emulated_device::seed_order(seed);
        std::vector<unsigned> noted(8);
        unsigned count = 0;
        run(8, note_order, noted.data(), &count);
        return noted;
    };
    std::set<std::vector<unsigned>> orders;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        std::vector<unsigned> order = order_of_seed(seed);
        EXPECT_EQ(order_of_seed(seed), order) << "the same seed gives the same order";
        orders.insert(order);
        std::sort(order.begin(), order.end());
        EXPECT_EQ(order, (std::vector<unsigned>{0, 1, 2, 3, 4, 5, 6, 7}));
    }
    EXPECT_GT(orders.size(), 4U);
}

TEST(DeviceChecksEmulated, AGridThatDoesNotWaitForItselfReadsOldWords) {
    const auto words_read = [](bool waits) {
        std::vector<unsigned> written(4, 0);
        std::vector<unsigned> read(4, 0);
        run_together(4, pass_on, written.data(), read.data(), waits);
        return read;
    };
    bool old_words = false;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        emulated_device::seed_order(seed);
        EXPECT_EQ(words_read(true), (std::vector<unsigned>{2, 3, 4, 1}));
        const std::vector<unsigned> read = words_read(false);
        old_words |= std::find(read.begin(), read.end(), 0U) != read.end();
    }
    EXPECT_TRUE(old_words);
}

TEST(DeviceChecksEmulated, ACooperativeGridMustFitTheDevice) {
    EXPECT_DEATH(run(2, wait_for_the_grid), "was not launched as a cooperative one");
    cudaLaunchAttribute attribute{};
    attribute.id = cudaLaunchAttributeCooperative;
    attribute.val.cooperative = 1;
    cuda::Stream stream;
    cudaLaunchConfig_t launch{};
    launch.gridDim = dim3(emulated_device::processors * emulated_device::blocks_of_processor + 1);
    launch.blockDim = dim3(cuda::block_threads);
    launch.stream = stream.get();
    launch.attrs = &attribute;
    launch.numAttrs = 1;
    EXPECT_EQ(cudaLaunchKernelEx(&launch, wait_for_the_grid), cudaErrorCooperativeLaunchTooLarge);
    launch.gridDim = dim3(0);
    EXPECT_EQ(cudaLaunchKernelEx(&launch, wait_for_the_grid), cudaErrorInvalidConfiguration);
}

TEST(DeviceChecksEmulated, NothingWaitsOrAllocatesWhileAGraphIsCaptured) {
    cuda::Stream stream;
    cuda::AwaitedEvent event;
    void* memory = nullptr;
    cudaGraph_t graph = nullptr;
    ASSERT_EQ(cudaStreamBeginCapture(stream.get(), cudaStreamCaptureModeThreadLocal), cudaSuccess);
    EXPECT_EQ(cudaStreamSynchronize(stream.get()), cudaErrorStreamCaptureUnsupported);
    EXPECT_THROW(event.wait(), DeviceError);
    EXPECT_EQ(cudaMallocHost(&memory, 16), cudaErrorStreamCaptureUnsupported);
    EXPECT_EQ(cudaMallocFromPoolAsync(&memory, 16, nullptr, stream.get()), cudaErrorStreamCaptureUnsupported);
    ASSERT_EQ(cudaStreamEndCapture(stream.get(), &graph), cudaSuccess);
    EXPECT_EQ(cudaGraphDestroy(graph), cudaSuccess);
    EXPECT_EQ(cudaStreamSynchronize(stream.get()), cudaSuccess);
}

/// Scratch memory for n elements of anything.
struct Scratch {
    explicit Scratch(std::size_t n) : bytes(cuda::scratch_bytes(n, n, n)) {}
    cuda::Scratch less(std::size_t missing) { return {bytes.data(), bytes.size() - missing}; }
    std::vector<std::byte> bytes;
};

TEST(DeviceChecksEmulated, ScansAndSortsAreThoseOfTheStandardLibrary) {
    for (const std::size_t n : {0U, 1U, 31U, 256U, 4097U}) {
        SCOPED_TRACE(n);
        cuda::Stream stream;
        Scratch scratch(n);
        std::vector<std::uint64_t> sums(n), keys(n), room(n), expected(n);
        for (std::size_t i = 0; i < n; ++i) sums[i] = keys[i] = i * 7919 % 257;
        cuda::exclusive_sum(scratch.less(0), sums.data(), n, stream.get());
        const std::uint64_t* const sorted = cuda::sort(scratch.less(0), keys.data(), room.data(), n, 9, stream.get());
        expected = keys;
        std::sort(expected.begin(), expected.end());
        stream.synchronize();
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), sorted));
        std::uint64_t total = 0;
        for (std::size_t i = 0; i < n; total += i * 7919 % 257, ++i) ASSERT_EQ(sums[i], total);
    }
}

TEST(DeviceChecksEmulated, PairsWithEqualKeysKeepTheirOrderWhicheverBufferHoldsThem) {
    constexpr std::size_t n = 1000;
    std::set<bool> held_by_room;
    for (int call = 0; call < 4; ++call) {
        cuda::Stream stream;
        Scratch scratch(n);
        std::vector<std::uint64_t> keys(n), room(n);
        std::vector<std::uint32_t> values(n), values_room(n);
        constexpr unsigned bits = 42;
        for (std::size_t i = 0; i < n; ++i) {
            // The bits above the sorted ones would order them the other way round.
            keys[i] = (i % 3) << (bits - 2) | (n - i) << bits;
            values[i] = static_cast<std::uint32_t>(i);
        }
        const cuda::SortedPairs sorted = cuda::sort_with_values(
            scratch.less(0), {keys.data(), values.data()}, {room.data(), values_room.data()}, n, bits, stream.get());
        held_by_room.insert(sorted.keys == room.data());
        EXPECT_EQ(sorted.keys == room.data(), sorted.values == values_room.data());
        stream.synchronize();
        const auto key = [&](std::size_t i) { return sorted.keys[i] & ((std::uint64_t{1} << bits) - 1); };
        for (std::size_t i = 1; i < n; ++i) {
            ASSERT_LE(key(i - 1), key(i));
            if (key(i - 1) == key(i)) {
                ASSERT_GT(sorted.values[i], sorted.values[i - 1]);
            }
        }
    }
    EXPECT_EQ(held_by_room.size(), 2U) << "either may hold them";
}

TEST(DeviceChecksEmulated, ScratchMemoryThatIsTooSmallIsRefused) {
    constexpr std::size_t n = 10'000;
    cuda::Stream stream;
    Scratch scratch(n);
    std::vector<std::uint64_t> keys(n), room(n);
    std::vector<std::uint32_t> values(n), values_room(n);
    const auto sort = [&](std::size_t missing) {
        cuda::sort_with_values(scratch.less(missing), {keys.data(), values.data()}, {room.data(), values_room.data()},
                               n, 64, stream.get());
    };
    // Scans of counts by level take the most.
    std::vector<cuda::LevelCounts> counts(n);
    EXPECT_NO_THROW(cuda::exclusive_sum(scratch.less(0), counts.data(), n, stream.get()));
    EXPECT_THROW(cuda::exclusive_sum(scratch.less(1), counts.data(), n, stream.get()), DeviceError);
    EXPECT_NO_THROW(sort(0));
    EXPECT_THROW(sort(scratch.bytes.size() - 1024), DeviceError);
    EXPECT_THROW(cuda::sort(scratch.less(0), keys.data(), keys.data() + 1, n - 1, 64, stream.get()), DeviceError)
        << "buffers that overlap";
    stream.synchronize();
}

}  // namespace
}  // namespace meniscus
