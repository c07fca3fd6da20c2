// The CPU backend with the loops of the instruction set in use.
#include "base/instruction_set.hpp"
#include "pipeline/backend.hpp"

namespace meniscus::cpu {

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>& account) {
    switch (chosen_instruction_set()) {
#if defined(__x86_64__)
        case InstructionSet::avx512:
            return make_reconstruction<InstructionSet::avx512>(settings, options, account);
        case InstructionSet::avx2:
            return make_reconstruction<InstructionSet::avx2>(settings, options, account);
#elif defined(__aarch64__)
        case InstructionSet::neon:
            return make_reconstruction<InstructionSet::neon>(settings, options, account);
#endif
        default:
            return make_reconstruction<InstructionSet::portable>(settings, options, account);
    }
}

}  // namespace meniscus::cpu
