// Reads the choices from the environment.
#include "engine/cuda/fault_finding.hpp"

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

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

bool uses_graphs() {
    constexpr const char* variable = "MENISCUS_NO_GRAPH";
    const char* const given = std::getenv(variable);
    const std::string_view value = given == nullptr ? "" : given;
    if (value.empty() || value == "0") return true;
    if (value == "1") return false;
    throw InvalidInput(std::string(variable) + " is \"" + std::string(value) +
                       "\", must be 1 (frames run without graphs) or 0");
}

unsigned most_cooperative_blocks() {
    constexpr const char* variable = "MENISCUS_COOPERATIVE_BLOCKS";
    const char* const given = std::getenv(variable);
    const std::string_view value = given == nullptr ? "" : given;
    if (value.empty()) return 0;
    unsigned blocks = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), blocks);
    if (error != std::errc() || end != value.data() + value.size() || blocks == 0)
        throw InvalidInput(std::string(variable) + " is \"" + std::string(value) +
                           "\", must be a number from 1 on; leave the variable unset for as many as run at once");
    return blocks;
}

}  // namespace meniscus::cuda
