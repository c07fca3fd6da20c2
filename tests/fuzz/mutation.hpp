// Damage to well-formed input, without libFuzzer.
#pragma once

#include <random>
#include <span>
#include <string>

namespace meniscus::fuzz {

/// One of the seeds with some of: a cut end, the end of another one, other bytes, numbers of extreme value in text and
/// binary, pieces taken out, doubled or exchanged. The same for the same state of `random`, which moves on.
std::string mutated(std::span<const std::string> seeds, std::mt19937& random);

}  // namespace meniscus::fuzz
