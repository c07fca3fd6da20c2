// Prefix sums and selection in parallel, with the same result for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/arrays.hpp"
#include "engine/cpu/workers.hpp"

namespace meniscus::cpu {

/// Scans pieces of a range in two passes; keeps the pieces' sums between calls.
class Scan {
public:
    explicit Scan(const std::shared_ptr<MemoryAccount>& account) : sums_(make_array<std::uint64_t>(account)) {}

    /// Calls write(i, sum of value(0) ... value(i - 1)) for every i; returns the whole sum. value() is called twice.
    template <class Value, class Write>
    std::uint64_t exclusive(Workers& workers, std::size_t n, const Value& value, const Write& write) {
        const std::size_t pieces = (n + piece - 1) / piece;
        resize_for_overwrite(sums_, pieces);
        workers.for_ranges(n, piece, [&](std::size_t begin, std::size_t end, unsigned) {
            std::uint64_t sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += value(i);
            sums_[begin / piece] = sum;
        });
        std::uint64_t total = 0;
        for (std::uint64_t& sum : sums_) {
            const std::uint64_t own = sum;
            sum = total;
            total += own;
        }
        workers.for_ranges(n, piece, [&](std::size_t begin, std::size_t end, unsigned) {
            std::uint64_t sum = sums_[begin / piece];
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t own = value(i);
                write(i, sum);
                sum += own;
            }
        });
        return total;
    }

private:
    static constexpr std::size_t piece = 4096;
    Array<std::uint64_t> sums_;
};

}  // namespace meniscus::cpu
