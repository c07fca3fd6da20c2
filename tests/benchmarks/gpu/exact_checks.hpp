// The checks of `meniscus-bench exact`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace meniscus::benchmarks {

/// One check's result.
struct Checked {
    std::string check;
    std::uint64_t n = 0;  ///< numbers or elements
    std::string run;      ///< plain; graph: captured and launched; replay: launched once more with other data
    std::uint64_t different = 0;
    std::string first_difference;
};
using OnChecked = std::function<void(const Checked&)>;

/// Compares the device with the host to the bit: roots and reciprocals of `one_argument` bit patterns (a power of two
/// up to 2^32, which are all), quotients and fused sums of `more_arguments` random numbers. Two NaNs are the same.
void check_rounding(std::uint64_t one_argument, std::uint64_t more_arguments, const OnChecked& on_checked);

/// CUB's sorts and sums as the backend calls them (engine/cuda/scans.hpp), against std:: at sizes up to `most`.
void check_scans(std::uint64_t most, const OnChecked& on_checked);

}  // namespace meniscus::benchmarks
