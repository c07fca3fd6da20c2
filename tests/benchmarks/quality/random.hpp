// Random numbers that are the same everywhere: the distributions of the standard library are not.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

#include "compare/surface.hpp"

namespace meniscus::benchmarks::quality {

class Random {
public:
    /// The same name gives the same numbers.
    explicit Random(std::string_view name) : engine_(seed(name)) {}

    /// In [-1, 1).
    double next() { return static_cast<double>(engine_() >> 11U) * 0x1p-52 - 1.0; }
    /// Each coordinate in [-size, size).
    compare::Point next_point(double size) {
        const double x = size * next();
        const double y = size * next();
        return {x, y, size * next()};
    }

private:
    /// FNV-1a.
    static std::uint64_t seed(std::string_view name) {
        std::uint64_t hash = 0xcbf29ce484222325U;
        for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
        return hash;
    }

    std::mt19937_64 engine_;
};

}  // namespace meniscus::benchmarks::quality
