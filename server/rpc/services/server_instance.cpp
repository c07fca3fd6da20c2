#include "rpc/services/server_instance.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <random>
#include <string>
#include <utility>

namespace meniscus::server {

namespace {

constexpr const char* instance_key = "x-server-instance";

std::string random_name() {
    std::random_device device;
    std::uniform_int_distribution<std::uint64_t> numbers;
    return fmt::format("{:016x}", numbers(device));
}

class InstanceMarker final : public grpc::experimental::Interceptor {
public:
    explicit InstanceMarker(const std::string& name) : name_(name) {}

    void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
        using Point = grpc::experimental::InterceptionHookPoints;
        // A call that ends at once has initial metadata only where its handler gives some: by that, watchers know a
        // refusal.
        if (methods->QueryInterceptionHookPoint(Point::PRE_SEND_STATUS))
            methods->GetSendTrailingMetadata()->emplace(instance_key, name_);
        else if (methods->QueryInterceptionHookPoint(Point::PRE_SEND_INITIAL_METADATA))
            methods->GetSendInitialMetadata()->emplace(instance_key, name_);
        methods->Proceed();
    }

private:
    const std::string& name_;
};

class InstanceMarkers final : public grpc::experimental::ServerInterceptorFactoryInterface {
public:
    grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* /*call*/) override {
        return new InstanceMarker(name_);  // owned by the call
    }

private:
    const std::string name_ = random_name();
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_instance_marker() {
    return std::make_unique<InstanceMarkers>();
}

}  // namespace meniscus::server
