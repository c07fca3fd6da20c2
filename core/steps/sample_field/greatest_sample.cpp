// The greatest sample on the CPU: asked for only where there is no surface, so that one thread suffices.
#include <algorithm>

#include "steps/cpu_steps.hpp"
#include "steps/sample_field/greatest_sample.hpp"

namespace meniscus::cpu {

float greatest_sample(State& state) {
    const BlocksView blocks = state.blocks();
    float greatest = 0.0F;
    for (std::uint32_t block = 0; block < blocks.count; ++block)
        greatest = std::max(greatest, greatest_of_block(blocks, block, state.settings));
    return greatest;
}

}  // namespace meniscus::cpu
