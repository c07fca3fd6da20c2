// Choices of the environment.
#include "engine/cuda/fault_finding.hpp"

#include <cstdlib>
#include <string>
#include <string_view>

#include "meniscus/error.hpp"

namespace meniscus::cuda {

ArrayPlacement array_placement() {
    constexpr const char* variable = "MENISCUS_DEVICE_ARRAYS";
    const char* const given = std::getenv(variable);
    const std::string_view name = given == nullptr ? "" : given;
    if (name.empty() || name == "together") return ArrayPlacement::together;
    if (name == "guarded") return ArrayPlacement::guarded;
    if (name == "separate") return ArrayPlacement::separate;
    throw InvalidInput(std::string(variable) + " is \"" + std::string(name) +
                       "\", must be together, guarded or separate; leave the variable unset for the fastest");
}

}  // namespace meniscus::cuda
