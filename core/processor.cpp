// Compiled without AVX2 and FMA, so that it can say that they are missing.
#include "processor.hpp"

#include <fstream>

#include "meniscus/error.hpp"

namespace meniscus {

void require_supported_processor() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
        throw InvalidInput("this processor (" + processor_name() +
                           ") lacks AVX2 or FMA, which this build needs: run on a processor with both (Intel Haswell, "
                           "AMD Excavator or newer)");
#endif
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown processor";
}

}  // namespace meniscus
