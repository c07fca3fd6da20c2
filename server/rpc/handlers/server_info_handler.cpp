#include "rpc/handlers/server_info_handler.hpp"

#include <string>
#include <string_view>

#include "conversion/codec_conversion.hpp"
#include "rows/message_rows.hpp"

namespace meniscus::server {

namespace {

/// The limits that have a field there, by its name.
v1::Limits limits_message(const Limits& limits) {
    v1::Limits message;
    Limits::rows(limits, [&](std::string_view name, const auto& limit, const Facts& facts, const auto&...) {
        if (v1::Limits::descriptor()->FindFieldByName(std::string(name)) != nullptr)
            rows::write(limit, message, rows::MessageField(message, name), facts);
    });
    return message;
}

}  // namespace

v1::GetServerInfoResponse get_server_info(const BackendDescription& backend, unsigned threads, const Limits& limits,
                                          bool publishes) {
    v1::GetServerInfoResponse response;
    response.set_version(std::string(version()));
    response.set_backend(backend.name);
    response.set_device(backend.device);
    response.set_backend_reason(backend.reason);
    response.set_threads(threads);
    conversion::add_known_codecs(*response.mutable_codecs());
    response.set_publishes(publishes);
    response.set_checks_published(limits.check_published);
    *response.mutable_limits() = limits_message(limits);
    return response;
}

}  // namespace meniscus::server
