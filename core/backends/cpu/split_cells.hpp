// Step 2 on the CPU.
#pragma once

#include <variant>

#include "backends/cpu/surface.hpp"
#include "stages/split_cells.hpp"

namespace meniscus::cpu {

/// Any one of the rules that decide a cell's level.
using SplitCriterion = std::variant<UniformCriterion, CountCriterion>;

/// Every stored cell gets the level that the criterion asks for, and joins the surface band if it may hold surface.
/// Base vertices must be sampled; bounds: per block, above every field value in its cell.
void split_cells(Surface& surface, const SplitCriterion& criterion, const Array<float>& bounds);

}  // namespace meniscus::cpu
