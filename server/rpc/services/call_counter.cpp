#include "rpc/services/call_counter.hpp"

#include <array>
#include <chrono>
#include <string_view>
#include <utility>

#include "rpc/services/known_methods.hpp"

namespace meniscus::server {

std::string_view metric_name_of(grpc::StatusCode code) {
    static constexpr std::array<std::string_view, 17> names{
        "OK",       "Canceled",       "Unknown",          "InvalidArgument",   "DeadlineExceeded",
        "NotFound", "AlreadyExists",  "PermissionDenied", "ResourceExhausted", "FailedPrecondition",
        "Aborted",  "OutOfRange",     "Unimplemented",    "Internal",          "Unavailable",
        "DataLoss", "Unauthenticated"};
    const auto index = static_cast<std::size_t>(code);
    return index < names.size() ? names[index] : "Unknown";
}

namespace {

class CallCounter final : public grpc::experimental::Interceptor {
public:
    CallCounter(Metrics& metrics, const Metrics::Method& method) : metrics_(metrics), method_(method) {
        metrics_.call_started(method_);
    }

    void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
        if (methods->QueryInterceptionHookPoint(grpc::experimental::InterceptionHookPoints::PRE_SEND_STATUS)) {
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun_;
            metrics_.call_ended(method_, metric_name_of(methods->GetSendStatus().error_code()), taken.count());
        }
        methods->Proceed();
    }

private:
    Metrics& metrics_;
    const Metrics::Method& method_;
    const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

class CallCounters final : public grpc::experimental::ServerInterceptorFactoryInterface {
public:
    explicit CallCounters(std::shared_ptr<Metrics> metrics) : metrics_(std::move(metrics)) {}

    grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* call) override {
        return new CallCounter(*metrics_, known_method(call->method()));  // owned by the call
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
