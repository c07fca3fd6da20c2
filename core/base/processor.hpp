// The processor that the program runs on.
#pragma once

#include <string>

namespace meniscus {

/// The processor's name for itself.
std::string processor_name();

}  // namespace meniscus
