// The two ways in which a request can be refused. Everything else that is thrown is a defect.
#pragma once

#include <stdexcept>
#include <string>

namespace meniscus {

/// The caller's input is wrong (a setting, a position, a file). The message names the value and what is allowed.
class InvalidInput : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The input is well formed but larger than a limit. The message names the value, the limit and what to do.
class LimitExceeded : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace meniscus
