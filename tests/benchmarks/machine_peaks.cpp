#include "machine_peaks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace meniscus::benchmarks {
namespace {

/// Enough independent sums to hide the latency of an addition.
constexpr std::size_t sums = 12;

#if defined(__AVX2__) && defined(__FMA__)
using Lanes = __m256;
constexpr std::size_t lane_count = 8;
inline Lanes same(float value) {
    return _mm256_set1_ps(value);
}
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return _mm256_fmadd_ps(a, b, c);
}
inline float first(Lanes a) {
    return _mm256_cvtss_f32(a);
}
#else
using Lanes = float;
constexpr std::size_t lane_count = 1;
inline Lanes same(float value) {
    return value;
}
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return std::fma(a, b, c);
}
inline float first(Lanes a) {
    return a;
}
#endif

/// Keeps the compiler from dropping what `value` needs.
void use(float value) {
    [[maybe_unused]] static volatile float sink;
    sink = value;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The most of `amount` per second over some tries of `work`: others may use the machine meanwhile.
template <class Work>
double best_rate(double amount, const Work& work) {
    constexpr int tries = 15;
    double best = 0.0;
    for (int i = 0; i < tries; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::max(best, amount / seconds_since(start));
    }
    return best;
}

double measure_multiply_adds() {
    constexpr std::size_t rounds = 1'000'000;
    return best_rate(static_cast<double>(rounds * sums * lane_count), [] {
        Lanes sum[sums];
        for (Lanes& s : sum) s = same(1.0F);
        const Lanes factor = same(0.999F);
        const Lanes summand = same(0.001F);
        for (std::size_t i = 0; i < rounds; ++i)
            for (std::size_t j = 0; j < sums; ++j) sum[j] = multiply_add(sum[j], factor, summand);
        for (const Lanes& s : sum) use(first(s));
    });
}

double measure_copies() {
    constexpr std::size_t bytes = std::size_t{256} << 20;
    const auto from = std::make_unique<std::byte[]>(bytes);
    const auto to = std::make_unique<std::byte[]>(bytes);
    return best_rate(static_cast<double>(bytes), [&] {
        std::memcpy(to.get(), from.get(), bytes);
        constexpr std::size_t middle = bytes / 2;
        use(static_cast<float>(to[middle]));
    });
}

}  // namespace

MachinePeaks measure_peaks() {
    return {measure_multiply_adds(), measure_copies()};
}

}  // namespace meniscus::benchmarks
