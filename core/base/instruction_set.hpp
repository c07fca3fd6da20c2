// The instruction sets that the loops of the CPU backend are compiled for. All give the same bits.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace meniscus {

enum class InstructionSet : std::uint8_t {
    portable,  ///< any processor of the architecture
    neon,      ///< Arm, 64 bits
    avx2,      ///< x86-64 with AVX2, FMA, BMI and BMI2: Intel Haswell, AMD Excavator or newer
    avx512,    ///< x86-64 with AVX-512 F, VL, BW and DQ beside those
};
std::string_view name_of(InstructionSet set);

/// The instruction sets of this build that the processor has; the fastest is the last.
std::vector<InstructionSet> usable_instruction_sets();

/// The fastest, or the one that the environment variable MENISCUS_INSTRUCTIONS names. Throws InvalidInput if it names
/// none that can be used.
InstructionSet chosen_instruction_set();

}  // namespace meniscus
