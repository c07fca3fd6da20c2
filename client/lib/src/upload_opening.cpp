#include "upload_opening.hpp"

#include <chrono>
#include <cstdint>
#include <random>
#include <span>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {

namespace {

std::uint64_t random_run_id() {
    std::random_device device;
    std::uniform_int_distribution<std::uint64_t> ids(1);
    return ids(device);
}

v1::UploadPolicy to_wire(UploadPolicy policy) {
    switch (policy) {
        case UploadPolicy::every_frame:
            return v1::UPLOAD_POLICY_EVERY_FRAME;
        case UploadPolicy::latest:
            return v1::UPLOAD_POLICY_LATEST;
        case UploadPolicy::every_nth:
            return v1::UPLOAD_POLICY_EVERY_NTH;
    }
    return v1::UPLOAD_POLICY_UNSPECIFIED;
}

/// The fields that both openings have.
template <class Open>
void fill(Open& open, const std::string& session_id, const StreamOptions& options) {
    open.set_session_id(session_id);
    open.set_policy(to_wire(options.policy));
    open.set_nth(options.nth);
    open.set_reconnect_seconds(std::chrono::duration<double>(options.reconnect).count());
    open.set_run_id(options.run != 0 ? options.run : random_run_id());
    if (options.parts > 1) open.set_parts(options.parts);
    open.set_part(options.part);
}

template <class Request>
UploadOpening opening_by(const char* method, Request& request, const StreamOptions& options) {
    std::string first = request.SerializeAsString();
    request.mutable_open()->set_resumes(true);
    return {.method = method,
            .request = std::move(first),
            .request_again = request.SerializeAsString(),
            .sends_parts = options.parts > 1};
}

}  // namespace

UploadOpening stream_opening(const std::string& session_id, const StreamOptions& options, const WireCodecs& codecs) {
    v1::StreamRequest request;
    v1::StreamOpen& open = *request.mutable_open();
    fill(open, session_id, options);
    open.set_receive_meshes(options.receive_meshes);
    open.set_normal_bits(static_cast<std::uint32_t>(asked_normal_bits(options.normals_by, options.normal_bits)));
    open.set_with_spray(options.spray);
    *open.mutable_attributes() = conversion::to_wire(std::span(options.attributes));
    *open.mutable_codecs() = codecs;
    return opening_by("/meniscus.v1.SurfaceService/Stream", request, options);
}

UploadOpening publish_opening(const std::string& session_id, const StreamOptions& options) {
    v1::PublishRequest request;
    fill(*request.mutable_open(), session_id, options);
    return opening_by("/meniscus.v1.SurfaceService/Publish", request, options);
}

}  // namespace meniscus::client
