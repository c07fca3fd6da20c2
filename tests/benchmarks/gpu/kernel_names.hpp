// The names of kernels as a reader knows them: without namespaces and parameters.
#pragma once

#include <string>

namespace meniscus::benchmarks {

/// The plain form of a mangled name, such as `place_listed<true ParticleField<Poly6>>`; without commas, for tables.
std::string plain_kernel_name(const char* mangled);

/// The plain name of the kernel at this address. Throws DeviceError if CUDA does not know it.
std::string kernel_name(const void* kernel);

}  // namespace meniscus::benchmarks
