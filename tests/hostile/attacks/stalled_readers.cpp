// Readers of a recording that take every place and read nothing more.
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "meniscus/error.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int places = 16;
constexpr double pause_seconds = 2.0;

bool may_read(client::Client& client, const std::string& id) {
    try {
        return client.read_recording(id, 1).next().has_value();
    } catch (const LimitExceeded&) {
        return false;
    }
}

}  // namespace

std::vector<Figure> stalled_readers(const std::string& program) {
    const Folder folder;
    TargetOptions options;
    options.arguments = {
        "--record",           folder.path().string(),       "--max-recording-readers", std::to_string(places),
        "--max-reader-pause", std::to_string(pause_seconds)};
    const Target target(program, options);
    client::Client client(target.address());
    // More than gRPC takes for a reader that does not read.
    const std::string id = record(client, block_of_particles(24, true), 12);
    std::vector<client::Client> attackers;
    std::vector<client::RecordingReader> stalled;
    attackers.reserve(places);
    for (int i = 0; i < places; ++i) {
        attackers.emplace_back(target.address());
        stalled.push_back(attackers.back().read_recording(id, 1));
        if (!stalled.back().next()) throw std::runtime_error("an attacker cannot read");
    }
    const auto begin = Clock::now();
    while (!may_read(client, id)) {
        if (Clock::now() - begin > std::chrono::minutes(2)) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const std::chrono::duration<double> waited = Clock::now() - begin;
    return {{"until another may read, with --max-reader-pause 2", waited.count(), pause_seconds + 1.0, "s"}};
}

}  // namespace meniscus::hostile
