// Damage to well-formed input, without libFuzzer.
#pragma once

#include <random>
#include <string>

namespace meniscus::fuzz {

/// The seed with some of: a cut end, other bytes, numbers of extreme value in text and binary, pieces taken out,
/// doubled or exchanged. The same for the same state of `random`, which moves on.
std::string mutated(const std::string& seed, std::mt19937& random);

}  // namespace meniscus::fuzz
