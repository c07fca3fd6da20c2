// A small message that becomes a huge one where it is decompressed before the caller is known (D2).
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../target.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::size_t mebibyte = 1 << 20;
constexpr std::size_t bomb_mebibytes = 512;
constexpr int clients = 5;

/// Half a megabyte on the wire.
grpc::ByteBuffer zeros() {
    const std::vector<char> bytes(mebibyte, '\0');
    const std::vector<grpc::Slice> slices(bomb_mebibytes, grpc::Slice(bytes.data(), bytes.size()));
    return {slices.data(), slices.size()};
}

void throw_at(const std::string& address, const grpc::ByteBuffer& bomb) {
    grpc::ChannelArguments arguments;
    arguments.SetMaxSendMessageSize(-1);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    grpc::GenericStub stub(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
    grpc::ClientContext context;
    context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(2));
    grpc::CompletionQueue queue;
    const auto call = stub.PrepareUnaryCall(&context, "/meniscus.v1.SessionService/ListSessions", bomb, &queue);
    call->StartCall();
    grpc::ByteBuffer answer;
    grpc::Status status;
    call->Finish(&answer, &status, nullptr);
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
}

}  // namespace

std::vector<Figure> gzip_bomb(const std::string& program) {
    Target target(program);
    const grpc::ByteBuffer bomb = zeros();
    const double before = static_cast<double>(target.peak_bytes());
    std::vector<std::thread> threads;
    threads.reserve(clients);
    for (int i = 0; i < clients; ++i) threads.emplace_back([&] { throw_at(target.address(), bomb); });
    for (std::thread& thread : threads) thread.join();
    const double after = static_cast<double>(target.peak_bytes());
    return {{"memory at its peak, above that before", (after - before) / 1e6, 16.0, "MB"}};
}

}  // namespace meniscus::hostile
