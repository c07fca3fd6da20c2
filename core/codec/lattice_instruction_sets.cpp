// The lattice coder with the loops of the instruction set in use.
#include "codec/lattice/lattice_coder.hpp"

namespace meniscus {

std::unique_ptr<LatticeCoder> make_lattice_coder() {
    switch (chosen_instruction_set()) {
#if defined(__x86_64__)
        case InstructionSet::avx512:
            return make_lattice_coder<InstructionSet::avx512>();
        case InstructionSet::avx2:
            return make_lattice_coder<InstructionSet::avx2>();
#elif defined(__aarch64__)
        case InstructionSet::neon:
            return make_lattice_coder<InstructionSet::neon>();
#endif
        default:
            return make_lattice_coder<InstructionSet::portable>();
    }
}

}  // namespace meniscus
