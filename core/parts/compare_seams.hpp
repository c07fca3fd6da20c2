// The parts whose seams differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/part.hpp"

namespace meniscus {

/// A seam as one of the parts beside it has found it.
struct PartSeam {
    Seam seam;
    std::uint64_t part = 0;  ///< its number
};

struct UnequalSeams {
    std::vector<std::size_t> parts;  ///< numbers of the parts beside them, ascending, each once
    std::uint64_t count = 0;
};

/// seams: of all parts. own: the parts' boxes.
UnequalSeams compare_seams(std::span<const PartSeam> seams, std::span<const BrickBox> own);

}  // namespace meniscus
