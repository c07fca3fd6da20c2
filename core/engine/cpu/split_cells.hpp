// Step 2 on the CPU.
#pragma once

#include <variant>

#include "engine/cpu/surface.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cpu {

/// Any one of the rules that decide a cell's level.
using SplitRule = std::variant<UniformRule, CountRule, CurvatureRule>;

/// Puts the stored cells that may hold surface into the band, at level 1. Base vertices must be sampled.
void find_band(Surface& surface, const Array<CellReach>& reaches);

/// The level that the rule asks for in one cell.
int wanted_level(const SplitRule& rule, const BlocksView& blocks, std::uint32_t block);
/// Gives every cell of the band the level that the rule asks for.
void split_cells(Surface& surface, const SplitRule& rule);

}  // namespace meniscus::cpu
