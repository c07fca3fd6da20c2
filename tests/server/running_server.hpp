// A server in the test's process, and clients of it.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "connection/connection.hpp"
#include "conversion/particle_arrays.hpp"
#include "daemon/server.hpp"
#include "meniscus/client/client.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {

inline ServerOptions test_options() {
    static std::atomic<int> number{0};
    ServerOptions options;
    options.listen = "unix:" + (std::filesystem::temp_directory_path() /
                                ("meniscus-test-" + std::to_string(::getpid()) + "-" + std::to_string(number++)))
                                   .string();
    options.backend.threads = 2;
    options.shutdown_grace = std::chrono::seconds(60);
    return options;
}

struct RunningServer {
    explicit RunningServer(const ServerOptions& options = test_options()) : server(options), client(server.address()) {}

    /// A new session with the tests' settings.
    std::string session() {
        std::string id = client::new_session_id();
        client.create_session(id, settings());
        return id;
    }

    Server server;
    client::Client client;
};

/// The call itself, for what the client library would never send.
struct RawStream {
    RawStream(const std::string& address, const std::string& session_id, bool open = true,
              std::chrono::system_clock::time_point deadline = std::chrono::system_clock::time_point::max())
        : connection(address) {
        client::add_session_id(context, session_id);
        context.set_deadline(deadline);
        start();
        if (open) send_open(session_id);
    }
    /// Without metadata.
    explicit RawStream(const std::string& address) : connection(address) { start(); }

    void start() { call = connection.surfaces->Stream(&context); }

    void send_open(const std::string& session_id) {
        v1::StreamRequest request;
        request.mutable_open()->set_session_id(session_id);
        call->Write(request);
    }

    void send_begin(std::uint64_t index, std::uint64_t particles) {
        v1::StreamRequest request;
        request.mutable_frame_begin()->set_frame_index(index);
        request.mutable_frame_begin()->set_particle_count(particles);
        *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
        call->Write(request);
    }

    void send_chunk(std::size_t bytes) { send_data(std::string(bytes, '\0')); }

    void send_data(std::string data) {
        v1::StreamRequest request;
        request.mutable_frame_chunk()->set_data(std::move(data));
        call->Write(request);
    }

    void send_end() {
        v1::StreamRequest request;
        request.mutable_frame_end();
        call->Write(request);
    }

    /// Reads to the end; counts the frames that were answered.
    grpc::Status finish() {
        v1::StreamResponse response;
        while (call->Read(&response)) answered += response.has_frame_statistics() ? 1 : 0;
        return call->Finish();
    }

    client::Connection connection;
    grpc::ClientContext context;
    std::unique_ptr<grpc::ClientReaderWriter<v1::StreamRequest, v1::StreamResponse>> call;
    int answered = 0;
};

}  // namespace meniscus::server::test
