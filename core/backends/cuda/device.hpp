// Whether a GPU can reconstruct here.
#pragma once

#include <string>

namespace meniscus::cuda {

/// In one line, why no GPU is used.
std::string why_unavailable();

}  // namespace meniscus::cuda
