// A server with 200 calls, half of whose clients do not read, is asked to stop.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <list>
#include <thread>

#include "conversion/particle_arrays.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/v1/surface_service.grpc.pb.h"
#include "process.hpp"
#include "slowness.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

constexpr double grace = 2.0;  // seconds
constexpr int sessions = 10;
constexpr int watchers = 19;  // of a session; with its stream they are 20 calls

std::unique_ptr<v1::SurfaceService::Stub> surfaces(const std::string& address) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    // Small windows: a client that does not read holds up the server after a frame or two.
    arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 1 << 16);
    return v1::SurfaceService::NewStub(
        grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
}

/// A call that ends when its client has read all, or is not read from at all.
template <class Call, class Response>
class Reading {
public:
    void start(Call& call) {
        thread_ = std::thread([&call] {
            Response response;
            while (call.Read(&response)) {
            }
        });
    }
    ~Reading() {
        if (thread_.joinable()) thread_.join();
    }

private:
    std::thread thread_;
};

/// Uploads frames one after the other until the server ends the stream or takes no more.
class Uploader {
public:
    Uploader(v1::SurfaceService::Stub& stub, const std::string& session, bool reads) {
        context_.AddMetadata("x-session-id", session);
        call_ = stub.Stream(&context_);
        v1::StreamRequest open;
        open.mutable_open()->set_session_id(session);
        open.mutable_open()->set_receive_meshes(true);
        call_->Write(open);
        if (reads) reading_.start(*call_);
        pushing_ = std::thread([this] { push(); });
    }
    ~Uploader() {
        context_.TryCancel();
        pushing_.join();
    }

private:
    void push() {
        const Particles particles = spray(8);
        v1::StreamRequest begin;
        begin.mutable_frame_begin()->set_particle_count(particles.positions.size() / 3);
        *begin.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
        v1::StreamRequest chunk;
        chunk.mutable_frame_chunk()->set_data(particles.positions.data(), particles.positions.size() * sizeof(float));
        v1::StreamRequest end;
        end.mutable_frame_end();
        for (std::uint64_t i = 0;; ++i) {
            begin.mutable_frame_begin()->set_frame_index(i);
            if (!call_->Write(begin) || !call_->Write(chunk) || !call_->Write(end)) return;
        }
    }

    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReaderWriter<v1::StreamRequest, v1::StreamResponse>> call_;
    Reading<grpc::ClientReaderWriter<v1::StreamRequest, v1::StreamResponse>, v1::StreamResponse> reading_;
    std::thread pushing_;
};

class Watcher {
public:
    Watcher(v1::SurfaceService::Stub& stub, const std::string& session, bool reads) {
        context_.AddMetadata("x-session-id", session);
        v1::WatchRequest request;
        request.set_session_id(session);
        call_ = stub.Watch(&context_, request);
        call_->WaitForInitialMetadata();
        if (reads) reading_.start(*call_);
    }
    ~Watcher() { context_.TryCancel(); }

private:
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> call_;
    Reading<grpc::ClientReader<v1::WatchResponse>, v1::WatchResponse> reading_;
};

/// Seconds from SIGTERM to the end of the process.
double seconds_to_stop() {
    Process process(
        on_free_port({"--shutdown-grace", std::to_string(grace), "--max-sessions", std::to_string(sessions)}));
    const std::string address = process.address();
    client::Client client(address);
    const auto reading = surfaces(address);
    const auto stalling = surfaces(address);
    std::vector<std::string> ids;
    std::list<Watcher> watching;
    std::list<Uploader> uploading;
    for (int s = 0; s < sessions; ++s) {
        ids.push_back(client::new_session_id());
        client.create_session(ids.back(), settings());
        for (int w = 0; w < watchers; ++w) {
            const bool reads = (w + s) % 2 == 0;
            watching.emplace_back(reads ? *reading : *stalling, ids.back(), reads);
        }
        const bool reads = s % 2 == 0;
        uploading.emplace_back(reads ? *reading : *stalling, ids.back(), reads);
    }
    // So that everybody is owed something.
    for (const std::string& id : ids)
        while (client.session(id).frames < 2) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto start = std::chrono::steady_clock::now();
    process.signal(SIGTERM);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(ShutdownOfManyStreams, EndsWithinTheGracePeriodThoughHalfOfThemDoNotRead) {
    constexpr int rounds = 5;
    double slowest = 0.0;
    for (int i = 0; i < rounds; ++i) slowest = std::max(slowest, seconds_to_stop());
    std::printf("200 streams, %d times: stopped after %.3f s at most; the grace period is %.1f s\n", rounds, slowest,
                grace);
    EXPECT_LE(slowest, grace + 0.2 * (slowness - 1.0)) << "a sanitizer lengthens what comes after the grace";
}

}  // namespace
}  // namespace meniscus::server::test
