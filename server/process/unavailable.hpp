// What the server was asked for is right, but not to be had now.
#pragma once

#include <stdexcept>

namespace meniscus::server {

/// A later attempt may succeed.
struct Unavailable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace meniscus::server
