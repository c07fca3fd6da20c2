// The refusal of bytes that are no brick.
#pragma once

#include <string>

#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// Throws InvalidInput, which names the brick.
[[noreturn]] void refuse(const EncodedBrick& brick, const std::string& what);

}  // namespace meniscus
