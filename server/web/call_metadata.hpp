// Headers of a request that a call takes along.
#pragma once

#include <boost/beast/http/fields.hpp>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

/// names: of the headers. Throws InvalidInput for what gRPC cannot carry.
std::vector<std::pair<std::string, std::string>> call_metadata(const boost::beast::http::fields& request,
                                                               std::initializer_list<std::string_view> names);

}  // namespace meniscus::server
