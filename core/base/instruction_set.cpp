#include "base/instruction_set.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

constexpr const char* variable = "MENISCUS_INSTRUCTIONS";

#if defined(__x86_64__)
bool has_avx2() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}
bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
}
#endif

}  // namespace

std::string_view name_of(InstructionSet set) {
    switch (set) {
        case InstructionSet::portable:
            return "portable";
        case InstructionSet::neon:
            return "neon";
        case InstructionSet::avx2:
            return "avx2";
        case InstructionSet::avx512:
            return "avx512";
    }
    return {};
}

std::vector<InstructionSet> usable_instruction_sets() {
    std::vector<InstructionSet> sets{InstructionSet::portable};
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (has_avx2()) sets.push_back(InstructionSet::avx2);
    if (has_avx2() && has_avx512()) sets.push_back(InstructionSet::avx512);
#elif defined(__aarch64__)
    sets.push_back(InstructionSet::neon);
#endif
    return sets;
}

InstructionSet chosen_instruction_set() {
    const std::vector<InstructionSet> sets = usable_instruction_sets();
    const char* const wanted = std::getenv(variable);
    if (wanted == nullptr || *wanted == '\0') return sets.back();
    const auto found =
        std::find_if(sets.begin(), sets.end(), [&](InstructionSet set) { return name_of(set) == wanted; });
    if (found != sets.end()) return *found;
    std::string names;
    for (const InstructionSet set : sets) names += (names.empty() ? "" : ", ") + std::string(name_of(set));
    throw InvalidInput(std::string(variable) + " is \"" + wanted + "\": this build has for this processor " + names +
                       "; leave the variable unset for the fastest");
}

}  // namespace meniscus
