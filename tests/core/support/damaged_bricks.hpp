// Bricks whose bytes were cut or flipped.
#pragma once

#include <cstddef>
#include <vector>

#include "meniscus/brick_coding.hpp"

namespace meniscus::test {

/// The brick with its data cut at about every sixteenth of what is left, then `flipped` with one to three bits
/// flipped; the same ones for equal bricks.
std::vector<EncodedBrick> damaged(const EncodedBrick& whole, int flipped);

}  // namespace meniscus::test
