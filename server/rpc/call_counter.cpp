#include "rpc/call_counter.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace meniscus::server {

std::string_view name_of(grpc::StatusCode code) {
    static constexpr std::array<std::string_view, 17> names{
        "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
        "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
        "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
        "DATA_LOSS", "UNAUTHENTICATED"};
    const auto index = static_cast<std::size_t>(code);
    return index < names.size() ? names[index] : "UNKNOWN";
}

namespace {

class CallCounter final : public grpc::experimental::Interceptor {
public:
    explicit CallCounter(Metrics& metrics) : metrics_(metrics) {}

    void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
        if (methods->QueryInterceptionHookPoint(grpc::experimental::InterceptionHookPoints::PRE_SEND_STATUS))
            metrics_.call_ended(name_of(methods->GetSendStatus().error_code()));
        methods->Proceed();
    }

private:
    Metrics& metrics_;
};

class CallCounters final : public grpc::experimental::ServerInterceptorFactoryInterface {
public:
    explicit CallCounters(std::shared_ptr<Metrics> metrics) : metrics_(std::move(metrics)) {}

    grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* /*call*/) override {
        return new CallCounter(*metrics_);  // owned by the call
    }

private:
    const std::shared_ptr<Metrics> metrics_;
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> make_call_counter(
    std::shared_ptr<Metrics> metrics) {
    return std::make_unique<CallCounters>(std::move(metrics));
}

}  // namespace meniscus::server
