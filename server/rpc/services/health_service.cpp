#include "rpc/services/health_service.hpp"

#include <optional>

#include "grpc/health/v1/health.grpc.pb.h"
#include "rpc/calls/status.hpp"
#include "rpc/messages/wire_bytes.hpp"

namespace meniscus::server {

namespace {

using grpc::health::v1::Health;
using grpc::health::v1::HealthCheckResponse;

grpc::ByteBuffer message(bool serving) {
    HealthCheckResponse response;
    response.set_status(serving ? HealthCheckResponse::SERVING : HealthCheckResponse::NOT_SERVING);
    return serialized(response);
}

class CheckReactor final : public ByteReactor {
public:
    explicit CheckReactor(bool serving) : answer_(message(serving)) {
        StartWriteAndFinish(&answer_, {}, grpc::Status::OK);
    }
    void OnDone() override { delete this; }

private:
    const grpc::ByteBuffer answer_;
};

}  // namespace

/// Sends what the server is, and again when that changes.
class HealthService::WatchReactor final : public ByteReactor {
public:
    explicit WatchReactor(HealthService& service) : service_(service) {
        const std::lock_guard lock(service_.mutex_);
        service_.watches_.insert(this);
        write();
    }

    void OnWriteDone(bool ok) override {
        const std::lock_guard lock(service_.mutex_);
        writing_ = false;
        if (!ok) canceled_ = true;
        write();
    }

    void OnCancel() override {
        const std::lock_guard lock(service_.mutex_);
        canceled_ = true;
        write();
    }

    void OnDone() override {
        {
            const std::lock_guard lock(service_.mutex_);
            service_.watches_.erase(this);
        }
        delete this;
    }

    /// With the service's lock held.
    void write() {
        if (writing_ || finished_) return;
        if (canceled_) {
            finished_ = true;
            Finish(client_gone());
        } else if (sent_ != service_.serving_) {
            sent_ = service_.serving_;
            outgoing_ = message(service_.serving_);
            writing_ = true;
            StartWrite(&outgoing_);
        }
    }

private:
    HealthService& service_;
    grpc::ByteBuffer outgoing_;
    std::optional<bool> sent_;
    bool writing_ = false;
    bool canceled_ = false;
    bool finished_ = false;
};

HealthService::HealthService() : ByteService(Health::service_full_name()) {
    add("Check", [this](grpc::CallbackServerContext&) {
        const std::lock_guard lock(mutex_);
        return new CheckReactor(serving_);
    });
    add("Watch", [this](grpc::CallbackServerContext&) { return new WatchReactor(*this); });
}

void HealthService::set_serving(bool serving) {
    const std::lock_guard lock(mutex_);
    serving_ = serving;
    for (WatchReactor* watch : watches_) watch->write();
}

}  // namespace meniscus::server
