// The volume of the finished mesh on the CPU, four triangles at a time: 1 % of an adaptive frame, up to 2 % of a
// uniform one. One triangle at a time took half as long again; added up while triangles are written it took no less.
#include <atomic>
#include <cstring>

#include "steps/cpu_steps.hpp"
#include "steps/fill_cracks/volume.hpp"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace meniscus::cpu {
namespace {

#if defined(__AVX2__)

/// Four numbers of 64 bits. Of factors only the low 32 bits count, signed: the upper ones may be anything.
struct FourIntegers {
    __m256i v;
    friend FourIntegers operator+(FourIntegers a, FourIntegers b) { return {_mm256_add_epi64(a.v, b.v)}; }
    friend FourIntegers operator-(FourIntegers a, FourIntegers b) { return {_mm256_sub_epi64(a.v, b.v)}; }
    friend FourIntegers operator*(FourIntegers a, FourIntegers b) { return {_mm256_mul_epi32(a.v, b.v)}; }
};

/// Two neighboring coordinates.
std::int64_t pair_at(const std::int32_t* coordinates) {
    std::int64_t pair = 0;
    std::memcpy(&pair, coordinates, sizeof pair);
    return pair;
}

/// Sums from `at` on over whole groups of four triangles; moves `at` behind them.
std::uint64_t sum_by_fours(const LatticePosition* vertices, const Triangle* triangles, std::size_t& at,
                           std::size_t end) {
    FourIntegers sum{_mm256_setzero_si256()};
    for (; at + 4 <= end; at += 4) {
        FourIntegers x[3], y[3], z[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const auto coordinates = [&](std::size_t t) { return vertices[triangles[at + t][i]].data(); };
            const auto pairs = [&](std::size_t first) {
                return _mm256_set_epi64x(pair_at(coordinates(3) + first), pair_at(coordinates(2) + first),
                                         pair_at(coordinates(1) + first), pair_at(coordinates(0) + first));
            };
            x[i] = {pairs(0)};
            y[i] = {_mm256_srli_epi64(x[i].v, 32)};
            z[i] = {_mm256_srli_epi64(pairs(1), 32)};
        }
        sum = sum + sixfold_volume(x, y, z);
    }
    alignas(32) std::uint64_t lanes[4];
    _mm256_store_si256(reinterpret_cast<__m256i*>(lanes), sum.v);
    return lanes[0] + lanes[1] + lanes[2] + lanes[3];
}

#else

std::uint64_t sum_by_fours(const LatticePosition*, const Triangle*, std::size_t&, std::size_t) {
    return 0;
}

#endif

}  // namespace

void measure_volume(State& state, const Mesh& mesh) {
    state.sixfold_volume = 0;
    const std::atomic_ref<std::uint64_t> total(state.sixfold_volume);
    state.workers.for_ranges(mesh.triangles.size(), 16384, [&](std::size_t begin, std::size_t end, unsigned) {
        std::uint64_t sum = sum_by_fours(mesh.vertices.data(), mesh.triangles.data(), begin, end);
        for (; begin < end; ++begin)
            sum += static_cast<std::uint64_t>(sixfold_volume(mesh.vertices.data(), mesh.triangles[begin]));
        total.fetch_add(sum, std::memory_order_relaxed);
    });
}

}  // namespace meniscus::cpu
