#include "web/call_metadata.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "meniscus/error.hpp"

namespace meniscus::server {

std::vector<std::pair<std::string, std::string>> call_metadata(const boost::beast::http::fields& request,
                                                               std::initializer_list<std::string_view> names) {
    std::vector<std::pair<std::string, std::string>> metadata;
    for (const std::string_view name : names) {
        const auto [first, last] = request.equal_range(boost::beast::string_view(name.data(), name.size()));
        for (auto field = first; field != last; ++field) {
            std::string value(field->value());
            if (!std::ranges::all_of(value, [](char c) { return c >= ' ' && c <= '~'; }))
                throw InvalidInput(fmt::format("the header {} has characters other than printable ASCII", name));
            metadata.emplace_back(name, std::move(value));
        }
    }
    return metadata;
}

}  // namespace meniscus::server
