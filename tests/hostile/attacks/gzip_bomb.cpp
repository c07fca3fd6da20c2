// A small message that becomes a huge one where it is decompressed before the caller is known (D2).
#include <grpcpp/grpcpp.h>

#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../one_message.hpp"
#include "../target.hpp"
#include "large_message.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::size_t bomb_mebibytes = 512;  ///< half a megabyte on the wire
constexpr int clients = 5;

}  // namespace

std::vector<Figure> gzip_bomb(const std::string& program) {
    Target target(program);
    const grpc::ByteBuffer bomb = server::test::mebibytes_of_zeros(bomb_mebibytes);
    const double before = static_cast<double>(target.peak_bytes());
    std::vector<std::thread> threads;
    threads.reserve(clients);
    for (int i = 0; i < clients; ++i)
        threads.emplace_back([&] {
            send_one_message(target.address(), "/meniscus.v1.SessionService/ListSessions", bomb, GRPC_COMPRESS_GZIP);
        });
    for (std::thread& thread : threads) thread.join();
    const double after = static_cast<double>(target.peak_bytes());
    return {{"memory at its peak, above that before", (after - before) / 1e6, 16.0, "MB"}};
}

}  // namespace meniscus::hostile
