#include "rpc/services/known_methods.hpp"

#include <google/protobuf/descriptor.h>

#include <functional>
#include <map>
#include <string>

#include "grpc/health/v1/health.pb.h"
#include "meniscus/v1/recording_service.pb.h"
#include "meniscus/v1/server_service.pb.h"
#include "meniscus/v1/session_service.pb.h"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

namespace {

using Methods = std::map<std::string, Metrics::Method, std::less<>>;

std::string_view type_of(const google::protobuf::MethodDescriptor& method) {
    if (method.client_streaming()) return method.server_streaming() ? "bidi_stream" : "client_stream";
    return method.server_streaming() ? "server_stream" : "unary";
}

void add_services(const google::protobuf::FileDescriptor* file, Methods& methods) {
    if (file == nullptr) return;
    for (int i = 0; i < file->service_count(); ++i)
        for (int j = 0; j < file->service(i)->method_count(); ++j) {
            const google::protobuf::MethodDescriptor& method = *file->service(i)->method(j);
            const std::string& service = method.service()->full_name();
            methods.emplace("/" + service + "/" + method.name(),
                            Metrics::Method{.type = type_of(method), .service = service, .name = method.name()});
        }
}

/// From descriptors: for gRPC's handlers each of the server's own calls is a stream both ways.
Methods all_methods() {
    Methods methods;
    for (const google::protobuf::Descriptor* request :
         {v1::ListRecordingsRequest::descriptor(), v1::GetServerInfoRequest::descriptor(),
          v1::GetSessionRequest::descriptor(), v1::WatchRequest::descriptor(),
          grpc::health::v1::HealthCheckRequest::descriptor()})
        add_services(request->file(), methods);
    const google::protobuf::DescriptorPool& pool = *google::protobuf::DescriptorPool::generated_pool();
    for (const char* service : {"grpc.reflection.v1alpha.ServerReflection", "grpc.channelz.v1.Channelz"})
        if (const auto* found = pool.FindServiceByName(service)) add_services(found->file(), methods);
    return methods;
}

}  // namespace

const Metrics::Method& known_method(std::string_view path) {
    static const Methods methods = all_methods();
    static constexpr Metrics::Method unknown{.type = "unknown", .service = "unknown", .name = "unknown"};
    const auto method = methods.find(path);
    return method == methods.end() ? unknown : method->second;
}

}  // namespace meniscus::server
