#include "web/grpc_web.hpp"

#include <google/protobuf/descriptor.pb.h>

#include <map>
#include <string>

#include "meniscus/v1/recording_service.pb.h"
#include "meniscus/v1/server_service.pb.h"
#include "meniscus/v1/session_service.pb.h"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

namespace {

/// Whether the answer is a stream, by the request's target, of the methods that the contract declares to be without
/// side effects.
using Methods = std::map<std::string, bool, std::less<>>;

void add_methods(const google::protobuf::FileDescriptor& file, Methods& methods) {
    for (int i = 0; i < file.service_count(); ++i)
        for (int j = 0; j < file.service(i)->method_count(); ++j) {
            const google::protobuf::MethodDescriptor& method = *file.service(i)->method(j);
            if (method.options().idempotency_level() == google::protobuf::MethodOptions::NO_SIDE_EFFECTS)
                methods.emplace("/" + method.service()->full_name() + "/" + method.name(), method.server_streaming());
        }
}

const Methods& served_methods() {
    static const Methods methods = [] {
        Methods found;
        for (const google::protobuf::Descriptor* request :
             {v1::ListRecordingsRequest::descriptor(), v1::GetServerInfoRequest::descriptor(),
              v1::GetSessionRequest::descriptor(), v1::WatchRequest::descriptor()})
            add_methods(*request->file(), found);
        return found;
    }();
    return methods;
}

}  // namespace

bool GrpcWeb::serves(std::string_view target) const {
    return channel && served_methods().contains(target);
}

bool is_method(std::string_view target) {
    return target.starts_with("/meniscus.v1.");
}

bool is_stream(std::string_view target) {
    const auto method = served_methods().find(target);
    return method != served_methods().end() && method->second;
}

}  // namespace meniscus::server
