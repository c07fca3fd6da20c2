#include "rpc/messages/session_id.hpp"

#include <fmt/format.h>

#include <boost/uuid/string_generator.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <iterator>
#include <stdexcept>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view metadata_key = "x-session-id";

void require_session_id(std::string_view name, std::string_view id) {
    if (!is_session_id(id))
        throw InvalidInput(fmt::format("{} is {}; it must be a UUID of 8-4-4-4-12 lower-case hexadecimal digits", name,
                                       quoted(id, '"')));
}

}  // namespace

bool is_session_id(std::string_view text) {
    try {
        // The generator takes other forms, too: only the canonical one comes back as it was.
        return to_string(boost::uuids::string_generator()(text.begin(), text.end())) == text;
    } catch (const std::runtime_error&) {
        return false;
    }
}

std::string metadata_session_id(const grpc::ServerContextBase& context) {
    const auto& metadata = context.client_metadata();
    const auto [first, last] = metadata.equal_range(grpc::string_ref(metadata_key.data(), metadata_key.size()));
    if (first == last) throw InvalidInput(fmt::format("the call has no metadata {}", metadata_key));
    if (std::next(first) != last)
        throw InvalidInput(fmt::format("the call has metadata {} more than once", metadata_key));
    std::string id(first->second.data(), first->second.size());
    require_session_id(metadata_key, id);
    return id;
}

void require_same_session(std::string_view metadata, std::string_view message) {
    require_session_id("the message's session id", message);
    if (metadata != message)
        throw InvalidInput(
            fmt::format("metadata {} is {}, but the message's session id is {}", metadata_key, metadata, message));
}

}  // namespace meniscus::server
