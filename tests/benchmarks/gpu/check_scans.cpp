#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/graph.hpp"
#include "engine/cuda/scans.hpp"
#include "gpu/exact_checks.hpp"
#include "gpu/rounding.hpp"

namespace meniscus::benchmarks {
namespace {

using cuda::LevelCounts;

/// Nothing, one, less than a warp, a block, an odd number of tiles, and more.
constexpr std::uint64_t sizes[] = {0, 1, 31, 256, 4097, 1'000'000, 10'000'000};

/// One call: its arrays on the device, beginning at `base`, and on the host what is in them before and after.
/// Element: what is sorted or summed. Enqueue(first, second) puts the call on the stream and returns which of the two
/// arrays holds the result.
template <class Element>
class Call {
public:
    Call(std::string name, std::uint64_t n, std::byte* base, cuda::Stream& stream)
        : name_(std::move(name)),
          n_(n),
          first_(reinterpret_cast<Element*>(base)),
          second_(first_ + n),
          stream_(stream) {}

    /// Makes the i-th element of the data numbered `seed`.
    template <class Make, class Expected, class Enqueue>
    void check(const Make& make, const Expected& expected, const Enqueue& enqueue, const OnChecked& on_checked) {
        const auto fill = [&](std::uint64_t seed) {
            std::vector<Element> values(n_);
            for (std::uint64_t i = 0; i < n_; ++i) values[i] = make(seed * 1'000'000'007 + i);
            return values;
        };
        Element* result = nullptr;
        const auto look = [&](const std::vector<Element>& values, const char* run) {
            const std::vector<Element> should_be = expected(values);
            std::vector<Element> is(n_);
            copy(is.data(), result, cudaMemcpyDeviceToHost);
            Checked checked{name_, n_, run, 0, {}};
            for (std::uint64_t i = 0; i < n_; ++i) {
                if (std::memcmp(&is[i], &should_be[i], sizeof(Element)) == 0) continue;
                if (checked.different++ == 0) checked.first_difference = "element " + std::to_string(i);
            }
            on_checked(checked);
        };
        const std::vector<Element> one = fill(1);
        copy(first_, one.data(), cudaMemcpyHostToDevice);
        result = enqueue(first_, second_);
        look(one, "plain");

        cuda::Graph graph;
        graph.capture(stream_.get(), [&] { result = enqueue(first_, second_); });
        const std::vector<Element> two = fill(2);
        copy(first_, two.data(), cudaMemcpyHostToDevice);
        graph.launch(stream_.get());
        look(two, "graph");
        const std::vector<Element> three = fill(3);
        copy(first_, three.data(), cudaMemcpyHostToDevice);
        graph.launch(stream_.get());
        look(three, "replay");
    }

private:
    void copy(void* to, const void* from, cudaMemcpyKind kind) {
        if (n_ == 0) return;
        cuda::check(cudaMemcpyAsync(to, from, n_ * sizeof(Element), kind, stream_.get()), "cudaMemcpyAsync");
        stream_.synchronize();
    }

    std::string name_;
    std::uint64_t n_;
    Element* first_;
    Element* second_;
    cuda::Stream& stream_;
};

template <class Element>
std::vector<Element> sums_before(const std::vector<Element>& values) {
    std::vector<Element> sums(values.size());
    std::exclusive_scan(values.begin(), values.end(), sums.begin(), Element{});
    return sums;
}

/// The bits of a key that a sort looks at.
std::uint64_t lowest(std::uint64_t key, unsigned bits) {
    return key & ~std::uint64_t{0} >> (64 - bits);
}

/// As many as a frame of a million particles sorts by, and all.
constexpr unsigned sorted_bits[] = {23, 64};

std::vector<std::uint64_t> sorted(std::vector<std::uint64_t> keys, unsigned bits) {
    std::stable_sort(keys.begin(), keys.end(),
                     [&](std::uint64_t a, std::uint64_t b) { return lowest(a, bits) < lowest(b, bits); });
    return keys;
}

/// A key and its value, as the host keeps them; equal keys come in the order of their values, which is that of the
/// input.
struct Pair {
    std::uint64_t key;
    std::uint32_t value;
};

/// Few different keys, so that most are equal to others.
void check_pairs(std::uint64_t n, unsigned bits, std::byte* base, const cuda::Scratch& scratch, cuda::Stream& stream,
                 const OnChecked& on_checked) {
    auto* const keys = reinterpret_cast<std::uint64_t*>(base);
    auto* const values = reinterpret_cast<std::uint32_t*>(keys + 2 * n);
    Checked checked{"sort_pairs by " + std::to_string(bits) + " bits", n, "plain", 0, {}};
    std::vector<std::uint64_t> host_keys(n);
    std::vector<std::uint32_t> host_values(n);
    std::vector<Pair> expected(n);
    for (std::uint64_t i = 0; i < n; ++i) {
        host_keys[i] = random_bits(random_bits(i) % (n / 4 + 1));
        host_values[i] = static_cast<std::uint32_t>(i);
        expected[i] = {host_keys[i], host_values[i]};
    }
    std::stable_sort(expected.begin(), expected.end(),
                     [&](const Pair& a, const Pair& b) { return lowest(a.key, bits) < lowest(b.key, bits); });
    const auto copy = [&](void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
        if (bytes != 0) cuda::check(cudaMemcpyAsync(to, from, bytes, kind, stream.get()), "cudaMemcpyAsync");
    };
    copy(keys, host_keys.data(), n * sizeof(std::uint64_t), cudaMemcpyHostToDevice);
    copy(values, host_values.data(), n * sizeof(std::uint32_t), cudaMemcpyHostToDevice);
    const cuda::SortedPairs result =
        cuda::sort_with_values(scratch, {keys, values}, {keys + n, values + n}, n, bits, stream.get());
    copy(host_keys.data(), result.keys, n * sizeof(std::uint64_t), cudaMemcpyDeviceToHost);
    copy(host_values.data(), result.values, n * sizeof(std::uint32_t), cudaMemcpyDeviceToHost);
    stream.synchronize();
    for (std::uint64_t i = 0; i < n; ++i) {
        if (host_keys[i] == expected[i].key && host_values[i] == expected[i].value) continue;
        if (checked.different++ == 0) checked.first_difference = "element " + std::to_string(i);
    }
    on_checked(checked);
}

}  // namespace

void check_scans(std::uint64_t most, const OnChecked& on_checked) {
    cuda::Stream stream;
    // Scratch memory for the largest size serves all, as in a reconstruction.
    const std::size_t scratch_bytes = cuda::scratch_bytes(most, most, most);
    const std::size_t array_bytes = 2 * most * (sizeof(std::uint64_t) + sizeof(std::uint32_t)) + 256;
    cuda::DeviceMemory memory(0, stream.get(), std::make_shared<MemoryAccount>());
    const std::size_t pieces[] = {scratch_bytes, array_bytes};
    memory.assign(pieces);
    const cuda::Scratch scratch{memory.get(0), scratch_bytes};
    std::byte* const base = memory.get(1);
    const auto in_place = [&](auto* first, auto*, std::uint64_t n) {
        cuda::exclusive_sum(scratch, first, n, stream.get());
        return first;
    };
    for (const std::uint64_t n : sizes) {
        if (n > most) break;
        const auto sum = [&](auto* first, auto* second) { return in_place(first, second, n); };
        for (const unsigned bits : sorted_bits) {
            const auto expected = [&](const std::vector<std::uint64_t>& keys) { return sorted(keys, bits); };
            const auto sort = [&](auto* first, auto* second) {
                return cuda::sort(scratch, first, second, n, bits, stream.get());
            };
            Call<std::uint64_t>("sort by " + std::to_string(bits) + " bits", n, base, stream)
                .check(random_bits, expected, sort, on_checked);
            check_pairs(n, bits, base, scratch, stream, on_checked);
        }
        Call<std::uint32_t>("sum of 4 bytes", n, base, stream)
            .check([](std::uint64_t i) { return static_cast<std::uint32_t>(random_bits(i)); },
                   sums_before<std::uint32_t>, sum, on_checked);
        Call<std::uint64_t>("sum of 8 bytes", n, base, stream)
            .check(random_bits, sums_before<std::uint64_t>, sum, on_checked);
        Call<LevelCounts>("sum of 16 bytes", n, base, stream)
            .check(
                [](std::uint64_t i) {
                    const std::uint64_t bits = random_bits(i);
                    const auto part = [bits](int k) { return static_cast<std::uint32_t>(bits >> (16 * k) & 0xFFFF); };
                    return LevelCounts{{part(0), part(1), part(2), part(3)}};
                },
                sums_before<LevelCounts>, sum, on_checked);
    }
}

}  // namespace meniscus::benchmarks
