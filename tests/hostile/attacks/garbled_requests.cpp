// Requests of bytes that are none: each is refused in words, which move nobody's cursor (D16).
#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/client_unary_call.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <random>
#include <string>

#include "../attacks.hpp"
#include "../target.hpp"
#include "connection/connection.hpp"
#include "meniscus/characters.hpp"

namespace meniscus::hostile {

namespace {

constexpr int requests = 3000;
constexpr const char* methods[] = {
    "/meniscus.v1.ServerService/GetServerInfo",     "/meniscus.v1.SessionService/CreateSession",
    "/meniscus.v1.SessionService/GetSession",       "/meniscus.v1.SessionService/ListSessions",
    "/meniscus.v1.SessionService/DeleteSession",    "/meniscus.v1.SurfaceService/Watch",
    "/meniscus.v1.SurfaceService/WatchParticles",   "/meniscus.v1.SurfaceService/Stream",
    "/meniscus.v1.RecordingService/ListRecordings", "/meniscus.v1.RecordingService/ReadRecording",
};

/// Bytes without order, or a field 1 of such bytes, which is a session's id.
std::string garbled(std::minstd_rand& random) {
    std::string bytes(random() % 60, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % 128);
    if (random() % 2 == 0) return bytes;
    std::string field{'\x0a', static_cast<char>(bytes.size())};
    return field += bytes;
}

}  // namespace

std::vector<Figure> garbled_requests(const std::string& program) {
    const Target target(program);
    const client::Connection connection(target.address());
    std::minstd_rand random(7);  // the same requests every time
    int wordless = 0;
    int raw = 0;
    for (int i = 0; i < requests; ++i) {
        grpc::ClientContext context;
        client::add_session_id(context, "00000000-0000-4000-8000-000000000000");
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
        const grpc::Slice slice(garbled(random));
        const grpc::ByteBuffer request(&slice, 1);
        grpc::ByteBuffer response;
        const grpc::internal::RpcMethod method(methods[i % std::size(methods)], grpc::internal::RpcMethod::NORMAL_RPC,
                                               connection.channel);
        const grpc::Status status =
            grpc::internal::BlockingUnaryCall(connection.channel.get(), method, &context, request, &response);
        if (status.ok()) continue;
        wordless += status.error_message().empty() ? 1 : 0;
        bool is_raw = false;
        for_each_character(status.error_message(), [&](const Character& character) {
            is_raw = is_raw || !character.code_point || is_control(*character.code_point) ||
                     is_filler(*character.code_point);
        });
        raw += is_raw ? 1 : 0;
    }
    return {{"refusals without a word, of 3000 requests", static_cast<double>(wordless), 0.0, ""},
            {"refusals with characters that are not visible", static_cast<double>(raw), 0.0, ""}};
}

}  // namespace meniscus::hostile
