// Huge messages of a caller with a token, to calls whose requests are small (N6).
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../one_message.hpp"
#include "../target.hpp"
#include "large_message.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

namespace {

constexpr std::size_t mebibytes = 512;
constexpr int at_a_time = 3;
constexpr const char* methods[] = {"/meniscus.v1.SessionService/ListSessions", "/meniscus.v1.SurfaceService/Watch",
                                   "/meniscus.v1.SurfaceService/Stream"};

}  // namespace

std::vector<Figure> large_requests(const std::string& program) {
    // Without tokens everybody is admitted.
    const Target target(program);
    const grpc::ByteBuffer message = server::test::mebibytes_of_zeros(mebibytes);
    client::Client honest(target.address());
    double slowest = 0.0;
    const double before = static_cast<double>(target.peak_bytes());
    for (const char* method : methods) {
        std::vector<std::thread> threads;
        threads.reserve(at_a_time);
        for (int i = 0; i < at_a_time; ++i)
            threads.emplace_back([&] { send_one_message(target.address(), method, message, GRPC_COMPRESS_NONE); });
        const auto begin = std::chrono::steady_clock::now();
        static_cast<void>(honest.sessions());
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        slowest = std::max(slowest, taken.count());
        for (std::thread& thread : threads) thread.join();
    }
    const double peak = static_cast<double>(target.peak_bytes());
    return {{"memory at its peak, above that before, for each of 3 connections", (peak - before) / 1e6 / at_a_time,
             40.0, "MB"},
            {"another caller's request meanwhile", slowest, 2.0, "s"}};
}

}  // namespace meniscus::hostile
