// meniscus-soak: connections and tiny frames without end for a meniscusd, whose memory and descriptors must not grow.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <future>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "connections.hpp"
#include "growth.hpp"
#include "process_size.hpp"
#include "tiny_frames.hpp"

namespace {

using namespace meniscus::soak;

constexpr std::uint64_t rounds = 40;
constexpr std::uint64_t warm_up_rounds = 10;  ///< rounds until buffers, pools and the heap have their size
/// Most growth of the heap; less than 42 bytes for each of 10^5 connections, 5 for each of 10^6 frames.
constexpr double allowed_bytes = 4 << 20;

struct Arguments {
    std::string server;
    pid_t process = 0;
    std::uint64_t connections = 0;
    std::uint64_t frames = 0;
};

template <class Number>
Number number(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value == 0)
        throw std::invalid_argument("'" + std::string(text) + "' is not a number above 0");
    return value;
}

/// Sockets whose clients have gone are closed when the server has noticed.
ProcessSize settled_size(pid_t process, std::size_t descriptors) {
    constexpr int attempts = 500;
    ProcessSize size = process_size(process);
    for (int i = 0; i < attempts && size.descriptors > descriptors; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        size = process_size(process);
    }
    return size;
}

/// Whether memory and descriptors stayed as they were.
bool soak(const Arguments& arguments) {
    TinyFrames tiny(arguments.server);
    tiny.send(1);
    const std::size_t descriptors = process_size(arguments.process).descriptors;
    std::vector<double> memory;
    std::size_t most_descriptors = 0;
    std::printf("%6s %12s %12s %12s %12s\n", "round", "connections", "frames", "memory MB", "descriptors");
    for (std::uint64_t round = 1; round <= rounds; ++round) {
        const auto share = [round](std::uint64_t all) { return all * round / rounds - all * (round - 1) / rounds; };
        auto connecting =
            std::async(std::launch::async, [&] { connect_many(arguments.server, share(arguments.connections)); });
        tiny.send(share(arguments.frames));
        connecting.get();
        const ProcessSize size = settled_size(arguments.process, descriptors);
        std::printf("%6llu %12llu %12llu %12.2f %12zu\n", static_cast<unsigned long long>(round),
                    static_cast<unsigned long long>(arguments.connections * round / rounds),
                    static_cast<unsigned long long>(arguments.frames * round / rounds),
                    static_cast<double>(size.memory_bytes) / 1e6, size.descriptors);
        std::fflush(stdout);
        if (round <= warm_up_rounds) continue;
        memory.push_back(static_cast<double>(size.memory_bytes));
        most_descriptors = std::max(most_descriptors, size.descriptors);
    }
    const double grown = growth(memory);
    std::printf("after %llu rounds: memory grew by %.2f MB (at most %.2f), descriptors from %zu to %zu\n",
                static_cast<unsigned long long>(warm_up_rounds), grown / 1e6, allowed_bytes / 1e6, descriptors,
                most_descriptors);
    return grown <= allowed_bytes && most_descriptors <= descriptors;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fputs("usage: meniscus-soak ADDRESS PID CONNECTIONS FRAMES\n", stderr);
        return 2;
    }
    try {
        return soak({argv[1], number<pid_t>(argv[2]), number<std::uint64_t>(argv[3]), number<std::uint64_t>(argv[4])})
                   ? 0
                   : 1;
    } catch (const std::invalid_argument& error) {
        std::fprintf(stderr, "meniscus-soak: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "meniscus-soak: %s\n", error.what());
        return 1;
    }
}
