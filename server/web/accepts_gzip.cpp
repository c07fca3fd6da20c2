#include "web/accepts_gzip.hpp"

#include <boost/beast/http/rfc7230.hpp>

#include <algorithm>

namespace meniscus::server {

namespace beast = boost::beast;

namespace {

/// "q=0", "q=0.0" and the like: the coding before it is refused.
bool refuses(const beast::http::param_list::value_type& parameter) {
    return beast::iequals(parameter.first, "q") && parameter.second.find_first_not_of("0.") == beast::string_view::npos;
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
    const beast::string_view value(accept_encoding.data(), accept_encoding.size());
    for (const auto& [coding, parameters] : beast::http::ext_list(value))
        if (beast::iequals(coding, "gzip")) return std::none_of(parameters.begin(), parameters.end(), refuses);
    return false;
}

}  // namespace meniscus::server
