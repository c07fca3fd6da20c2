#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "gpu/exact_checks.hpp"
#include "gpu/rounding.hpp"

namespace meniscus::benchmarks {
namespace {

constexpr std::uint64_t most_at_once = std::uint64_t{1} << 24;
constexpr unsigned many_processors = 512;

float compute_on_host(Operation operation, const Arguments& x) {
    switch (operation) {
        case Operation::root:
            return std::sqrt(x.a);
        case Operation::reciprocal:
            return 1.0F / x.a;
        case Operation::quotient:
            return x.a / x.b;
        case Operation::fused:
            return __builtin_fmaf(x.a, x.b, x.c);
    }
    return 0.0F;
}

bool are_same(float a, float b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0 || (std::isnan(a) && std::isnan(b));
}

/// The differences within a part of the arguments.
struct Differences {
    std::uint64_t count = 0;
    std::uint64_t first = 0;
};

Differences compare(Operation operation, std::uint64_t begin, std::uint64_t end, std::uint64_t first_of_results,
                    std::uint64_t count, const float* results) {
    Differences found;
    for (std::uint64_t i = begin; i < end; ++i) {
        if (are_same(results[i - first_of_results], compute_on_host(operation, arguments(operation, i, count))))
            continue;
        if (found.count++ == 0) found.first = i;
    }
    return found;
}

/// The same by as many threads as there are processors; the first difference is that of the lowest argument.
Differences compare_in_threads(Operation operation, std::uint64_t first, std::uint64_t n, std::uint64_t count,
                               const float* results) {
    const std::uint64_t parts = std::max(1U, std::thread::hardware_concurrency());
    std::vector<Differences> found(parts);
    {
        std::vector<std::jthread> threads;
        for (std::uint64_t part = 0; part < parts; ++part)
            threads.emplace_back([&, part] {
                found[part] =
                    compare(operation, first + n * part / parts, first + n * (part + 1) / parts, first, count, results);
            });
    }
    Differences all;
    for (const Differences& part : found) {
        if (all.count == 0) all.first = part.first;
        all.count += part.count;
    }
    return all;
}

std::string text_of(Operation operation, std::uint64_t i, std::uint64_t count, float on_device) {
    const Arguments x = arguments(operation, i, count);
    std::ostringstream text;
    text << std::hexfloat << "of " << x.a;
    if (operation == Operation::quotient || operation == Operation::fused) text << " and " << x.b;
    if (operation == Operation::fused) text << " and " << x.c;
    text << ": CPU " << compute_on_host(operation, x) << "; GPU " << on_device;
    return text.str();
}

}  // namespace

void check_rounding(std::uint64_t one_argument, std::uint64_t more_arguments, const OnChecked& on_checked) {
    cuda::Stream stream;
    cuda::DeviceMemory on_device(0, stream.get(), std::make_shared<MemoryAccount>());
    cuda::PinnedMemory on_host(std::make_shared<MemoryAccount>());
    const std::uint64_t at_once = std::min(most_at_once, std::max(one_argument, more_arguments));
    const std::size_t bytes = at_once * sizeof(float);
    on_device.assign(bytes);
    on_host.reserve(bytes);
    auto* const results = reinterpret_cast<float*>(on_device.get());
    const auto* const copied = reinterpret_cast<const float*>(on_host.get());
    const cuda::Launcher launch{stream.get(), many_processors};
    struct Named {
        Operation operation;
        const char* name;
        std::uint64_t count;
    };
    const std::array<Named, 4> operations = {{{Operation::root, "root", one_argument},
                                              {Operation::reciprocal, "reciprocal", one_argument},
                                              {Operation::quotient, "quotient", more_arguments},
                                              {Operation::fused, "fused", more_arguments}}};
    for (const auto& [operation, name, count] : operations) {
        Checked checked{name, count, "plain", 0, {}};
        for (std::uint64_t first = 0; first < count; first += at_once) {
            const std::uint64_t n = std::min(at_once, count - first);
            compute_on_device(operation, first, n, count, results, launch);
            cuda::check(
                cudaMemcpyAsync(on_host.get(), results, n * sizeof(float), cudaMemcpyDeviceToHost, stream.get()),
                "cudaMemcpyAsync");
            stream.synchronize();
            const Differences found = compare_in_threads(operation, first, n, count, copied);
            if (found.count != 0 && checked.different == 0)
                checked.first_difference = text_of(operation, found.first, count, copied[found.first - first]);
            checked.different += found.count;
        }
        on_checked(checked);
    }
}

}  // namespace meniscus::benchmarks
