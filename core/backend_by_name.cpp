// What users call the backends.
#include "meniscus/error.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

Backend backend_by_name(const std::string& name) {
    if (name == "auto") return Backend::automatic;
    if (name == "cpu") return Backend::cpu;
    if (name == "cuda") return Backend::cuda;
    throw InvalidInput("backend is '" + name + "', must be auto, cpu or cuda");
}

}  // namespace meniscus
