// Huge messages, not compressed, of strangers: to every call, at once (D2).
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../one_message.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "large_message.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::size_t mebibytes = 512;
constexpr int rounds = 3;
constexpr const char* answered_methods[] = {
    "/meniscus.v1.ServerService/GetServerInfo",      "/meniscus.v1.SessionService/CreateSession",
    "/meniscus.v1.SessionService/GetSession",        "/meniscus.v1.SessionService/ListSessions",
    "/meniscus.v1.SessionService/DeleteSession",     "/meniscus.v1.SurfaceService/Watch",
    "/meniscus.v1.SurfaceService/WatchParticles",    "/meniscus.v1.SurfaceService/Stream",
    "/meniscus.v1.RecordingService/ListRecordings",  "/meniscus.v1.RecordingService/ReadRecording",
    "/meniscus.v1.RecordingService/DeleteRecording", "/grpc.health.v1.Health/Check",
};

std::string tokens_file(const Folder& folder) {
    const std::filesystem::path path = folder.path() / "tokens";
    std::ofstream(path) << "admin root token-of-root-0123456789\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    return path.string();
}

}  // namespace

std::vector<Figure> unread_requests(const std::string& program) {
    const Folder folder;
    TargetOptions options;
    options.arguments = {"--tokens", tokens_file(folder), "--record", (folder.path() / "recordings").string()};
    const Target target(program, options);
    const grpc::ByteBuffer message = server::test::mebibytes_of_zeros(mebibytes);
    const double before = static_cast<double>(target.peak_bytes());
    std::atomic<int> failed{0};
    std::vector<std::thread> threads;
    for (const char* method : answered_methods)
        threads.emplace_back([&, method] {
            for (int i = 0; i < rounds; ++i) {
                const grpc::StatusCode code = send_one_message(target.address(), method, message, GRPC_COMPRESS_NONE);
                // A health check is OK.
                if (code != grpc::StatusCode::UNAUTHENTICATED && code != grpc::StatusCode::OK) ++failed;
            }
        });
    for (std::thread& thread : threads) thread.join();
    const double after = static_cast<double>(target.peak_bytes());
    // gRPC's buffers for what comes in are each connection's own.
    const double each = (after - before) / 1e6 / static_cast<double>(std::size(answered_methods));
    return {{"memory at its peak, above that before, for each of 11 connections", each, 16.0, "MB"},
            {"calls of 33 that were neither refused for want of a token nor OK", static_cast<double>(failed), 0.0, ""}};
}

}  // namespace meniscus::hostile
