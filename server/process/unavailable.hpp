// The error for a correct request that cannot be met now.
#pragma once

#include <stdexcept>

namespace meniscus::server {

/// A later attempt may succeed.
struct Unavailable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace meniscus::server
