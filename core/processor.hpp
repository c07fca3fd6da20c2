// What the kernels need of the processor.
#pragma once

#include <string>

namespace meniscus {

/// Throws InvalidInput, naming what is missing, on an x86-64 processor without AVX2 and FMA.
void require_supported_processor();

/// The processor's name, as it tells it.
std::string processor_name();

}  // namespace meniscus
