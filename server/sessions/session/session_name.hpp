// A session's name beside its id, in lines of text.
#pragma once

#include <string>

#include "meniscus/quoted.hpp"

namespace meniscus::server {

/// The name in quotation marks, with a space behind it; empty where there is none.
inline std::string named(const std::string& name) {
    return name.empty() ? "" : quoted(name, '"') + " ";
}

}  // namespace meniscus::server
