// A frame of nine tenths of the bytes in flight beside six sessions that keep the rest busy (N5).
#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t bytes_in_flight = 8'000'000;
constexpr int streams = 6;
constexpr std::size_t small_side = 39;  ///< 712 kB
constexpr std::size_t large_side = 84;  ///< 7.11 MB
constexpr int large_frames = 3;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Frames one after the other, until told to stop; counts those that were answered.
void keep_busy(const std::string& address, const std::atomic<bool>& stop, std::atomic<int>& answered) {
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings_of_attacks());
    const std::vector<float> positions = block_of_particles(small_side);
    ParticleFrame frame;
    frame.positions = positions;
    auto stream = client.stream(id, {.receive_meshes = false, .waiting_limit = 2});
    std::thread reader([&] {
        while (stream.next()) ++answered;
    });
    for (std::uint64_t i = 0; !stop; ++i) stream.push(frame, i, 0.0);
    stream.finish();
    reader.join();
}

}  // namespace

std::vector<Figure> starved_frames(const std::string& program) {
    TargetOptions options;
    options.arguments = {"--max-bytes-in-flight", std::to_string(bytes_in_flight)};
    const Target target(program, options);
    std::atomic<bool> stop{false};
    std::atomic<int> answered{0};
    std::vector<std::thread> busy;
    busy.reserve(streams);
    for (int i = 0; i < streams; ++i) busy.emplace_back([&] { keep_busy(target.address(), stop, answered); });
    const auto wait_for = [&](int more) {
        const int enough = answered + more;
        while (answered < enough) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    };
    wait_for(2 * streams);
    const auto begin = Clock::now();
    wait_for(10 * streams);
    const double round = seconds_since(begin) / 10.0;

    client::Client client(target.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings_of_attacks());
    const std::vector<float> positions = block_of_particles(large_side);
    ParticleFrame frame;
    frame.positions = positions;
    auto stream = client.stream(id, {.receive_meshes = false});
    double longest = 0.0;
    for (std::uint64_t i = 0; i < large_frames; ++i) {
        wait_for(10 * streams);
        const auto sent = Clock::now();
        stream.push(frame, i, 0.0);
        const auto answer = stream.next();
        // The wait for its bytes and the device: without its own time there.
        const double own = answer ? answer->statistics.total_seconds : 0.0;
        longest = std::max(longest, seconds_since(sent) - own);
    }
    stop = true;
    for (std::thread& each : busy) each.join();
    return {{"wait of a frame of 0.9 of the bytes in flight, beside rounds of " + std::to_string(round) + " s", longest,
             1.0 + 4.0 * round, "s"}};
}

}  // namespace meniscus::hostile
