// Frames that are announced as large as the limit, of which a byte comes now and then (D6).
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../raw_stream.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "meniscus/error.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t frame_limit = 16 << 20;
constexpr double upload_seconds = 3.0;

struct Honest {
    int refused = 0;
    double slowest = 0.0;  ///< longest time of a frame, seconds
};

/// Frames of several sizes, in a session of its own each.
Honest send_frames(client::Client& client) {
    Honest result;
    for (const std::size_t side : {1, 8, 20, 32, 60}) {
        const std::vector<float> positions = block_of_particles(side);
        ParticleFrame frame;
        frame.positions = positions;
        const std::string id = client::new_session_id();
        client.create_session(id, settings_of_attacks());
        const auto begin = Clock::now();
        try {
            auto stream = client.stream(id, {.receive_meshes = false});
            for (std::uint64_t i = 0; i < 3; ++i) stream.push(frame, i, 0.0);
            stream.finish();
            while (stream.next()) {
            }
        } catch (const LimitExceeded&) {
            ++result.refused;
        }
        result.slowest = std::max(result.slowest, std::chrono::duration<double>(Clock::now() - begin).count());
        client.delete_session(id);
    }
    return result;
}

/// Two frames of 0.6 of the limit at the same time.
int refused_large_frames(const Target& target) {
    // 12 bytes a particle: 95^3 of them are 0.61 of the limit.
    const std::vector<float> positions = block_of_particles(95);
    std::atomic<int> refused{0};
    std::vector<std::thread> senders;
    senders.reserve(2);
    for (int i = 0; i < 2; ++i)
        senders.emplace_back([&] {
            client::Client client(target.address());
            const std::string id = client::new_session_id();
            client.create_session(id, settings_of_attacks());
            ParticleFrame frame;
            frame.positions = positions;
            try {
                auto stream = client.stream(id, {.receive_meshes = false});
                stream.push(frame, 0, 0.0);
                stream.finish();
                while (stream.next()) {
                }
            } catch (const LimitExceeded&) {
                ++refused;
            }
        });
    for (std::thread& sender : senders) sender.join();
    return refused;
}

}  // namespace

std::vector<Figure> announcements(const std::string& program) {
    TargetOptions options;
    options.arguments = {"--max-bytes-in-flight", std::to_string(frame_limit), "--max-upload-seconds",
                         std::to_string(upload_seconds)};
    const Target target(program, options);
    client::Client client(target.address());
    const Honest before = send_frames(client);
    const auto begin = Clock::now();
    std::atomic<double> longest{0.0};
    std::vector<std::thread> attackers;
    attackers.reserve(2);
    for (int i = 0; i < 2; ++i)
        attackers.emplace_back([&] {
            client::Client own(target.address());
            const std::string id = client::new_session_id();
            own.create_session(id, settings_of_attacks());
            RawStream stream(target.address(), id);
            stream.begin(0, frame_limit / 12);
            // Something has to read: gRPC reports the end late to a client that only writes.
            std::atomic<bool> ended{false};
            std::thread reader([&] {
                stream.finish();
                longest = std::max(longest.load(), std::chrono::duration<double>(Clock::now() - begin).count());
                ended = true;
            });
            while (!ended && stream.bytes("x")) std::this_thread::sleep_for(std::chrono::milliseconds(100));
            reader.join();
        });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const Honest during = send_frames(client);
    for (std::thread& attacker : attackers) attacker.join();
    return {
        {"frames of others refused", static_cast<double>(during.refused), 0.0, ""},
        {"slowest frames of others, in times of those without the attack", during.slowest / before.slowest, 3.0, ""},
        // One of them waits for the other.
        {"until the attackers' streams end, with --max-upload-seconds 3", longest, 2 * upload_seconds + 2.0, "s"},
        {"frames refused of two of 0.6 of the limit", static_cast<double>(refused_large_frames(target)), 0.0, ""}};
}

}  // namespace meniscus::hostile
