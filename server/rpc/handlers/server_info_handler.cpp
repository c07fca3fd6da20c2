#include "rpc/handlers/server_info_handler.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <concepts>
#include <string>
#include <string_view>

#include "conversion/codec_conversion.hpp"
#include "process/seconds.hpp"

namespace meniscus::server {

namespace {

void set(v1::Limits& message, const google::protobuf::FieldDescriptor& field, std::chrono::milliseconds limit) {
    message.GetReflection()->SetDouble(&message, &field, seconds_of(limit));
}

void set(v1::Limits& message, const google::protobuf::FieldDescriptor& field, double limit) {
    message.GetReflection()->SetDouble(&message, &field, limit);
}

template <std::unsigned_integral Number>
void set(v1::Limits& message, const google::protobuf::FieldDescriptor& field, Number limit) {
    if (field.cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_UINT32)
        message.GetReflection()->SetUInt32(&message, &field, static_cast<std::uint32_t>(limit));
    else
        message.GetReflection()->SetUInt64(&message, &field, limit);
}

/// The limits that have a field there, by its name.
v1::Limits limits_message(const Limits& limits) {
    v1::Limits message;
    Limits::rows(limits, [&](std::string_view name, const auto& limit, const Facts&, const auto&...) {
        const auto* const field = v1::Limits::descriptor()->FindFieldByName(std::string(name));
        if (field != nullptr) set(message, *field, limit);
    });
    return message;
}

}  // namespace

v1::GetServerInfoResponse get_server_info(const BackendDescription& backend, unsigned threads, const Limits& limits) {
    v1::GetServerInfoResponse response;
    response.set_version(std::string(version()));
    response.set_backend(backend.name);
    response.set_device(backend.device);
    response.set_backend_reason(backend.reason);
    response.set_threads(threads);
    conversion::add_known_codecs(*response.mutable_codecs());
    *response.mutable_limits() = limits_message(limits);
    return response;
}

}  // namespace meniscus::server
