// Calls that begin and say nothing: they hold their metadata, and a server's end.
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "../attacks.hpp"
#include "../target.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int calls_of_each = 100;
constexpr const char* opened_methods[] = {
    "/meniscus.v1.SessionService/ListSessions",     "/meniscus.v1.SurfaceService/Watch",
    "/meniscus.v1.SurfaceService/WatchParticles",   "/meniscus.v1.SurfaceService/Stream",
    "/meniscus.v1.RecordingService/ListRecordings",
};
constexpr int calls = calls_of_each * static_cast<int>(std::size(opened_methods));

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Calls of one connection, each with metadata of 10 kB and no message.
class HalfOpenCalls {
public:
    explicit HalfOpenCalls(const std::string& address)
        : stub_(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())) {
        for (int i = 0; i < calls; ++i) {
            auto& call = calls_.emplace_back(std::make_unique<Call>());
            call->context.AddMetadata("x-session-id", "00000000-0000-4000-8000-00000000d3d3");
            call->context.AddMetadata("x-ballast", std::string(10'000, 'x'));
            call->stream = stub_.PrepareCall(&call->context, opened_methods[i % std::size(opened_methods)], &queue_);
            call->stream->StartCall(nullptr);
            wait();
            call->stream->Finish(&call->status, nullptr);
        }
    }
    ~HalfOpenCalls() {
        queue_.Shutdown();
        void* tag = nullptr;
        bool ok = false;
        while (queue_.Next(&tag, &ok)) {
        }
    }
    HalfOpenCalls(const HalfOpenCalls&) = delete;
    HalfOpenCalls& operator=(const HalfOpenCalls&) = delete;

    void wait_until_all_end() {
        for (int i = 0; i < calls; ++i) wait();
    }

private:
    struct Call {
        grpc::ClientContext context;
        std::unique_ptr<grpc::GenericClientAsyncReaderWriter> stream;
        grpc::Status status;
    };

    void wait() {
        void* tag = nullptr;
        bool ok = false;
        queue_.Next(&tag, &ok);
    }

    grpc::GenericStub stub_;
    grpc::CompletionQueue queue_;
    std::vector<std::unique_ptr<Call>> calls_;
};

}  // namespace

std::vector<Figure> half_open_calls(const std::string& program) {
    Target target(program);
    const double before = static_cast<double>(target.peak_bytes());
    double until_all_end = 0.0;
    {
        HalfOpenCalls attack(target.address());
        const auto begin = Clock::now();
        attack.wait_until_all_end();
        until_all_end = seconds_since(begin);
    }
    const double memory = (static_cast<double>(target.peak_bytes()) - before) / 1e6;
    const HalfOpenCalls beside_the_end(target.address());
    const End end = target.terminate();
    return {{"until 500 calls end of which no message comes", until_all_end, 12.0, "s"},
            {"memory at its peak, above that before", memory, 32.0, "MB"},
            {"from SIGTERM to the end, beside as many", end.seconds, 1.0, "s"}};
}

}  // namespace meniscus::hostile
