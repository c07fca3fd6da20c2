// Boost's string views as the standard library's.
#pragma once

#include <boost/beast/core/string.hpp>
#include <string_view>

namespace meniscus::server {

inline std::string_view view(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

}  // namespace meniscus::server
