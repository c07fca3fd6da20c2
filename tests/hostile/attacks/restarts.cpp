// A server that goes, and how soon its streams and watchers are back once it is (D5).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t restart_count = 40;
constexpr std::chrono::seconds patient{60};

/// 0.1 to 5 s, evenly on a scale of logarithms, and never twice the same.
Seconds outage(std::size_t restart) {
    return Seconds(0.1 * std::pow(50.0, static_cast<double>(restart) / (restart_count - 1)));
}

double median(std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

}  // namespace

std::vector<Figure> restarts(const std::string& program) {
    std::optional<Target> target(std::in_place, program);
    TargetOptions again;
    again.listen = target->address();
    client::Client client(again.listen);
    const std::string id = client::new_session_id();
    client.create_session(id, settings_of_attacks());
    auto stream = client.stream(id, {.reconnect = patient});
    auto watcher = client.watch(id, {.reconnect = patient});
    const std::vector<float> positions = block_of_particles(4);
    ParticleFrame frame;
    frame.positions = positions;
    stream.push(frame, 0, 0.0);
    if (!stream.next() || !watcher.next()) throw std::runtime_error("no frame before the first restart");
    std::vector<double> streams;
    std::vector<double> watchers;
    for (std::size_t restart = 0; restart < restart_count; ++restart) {
        auto shown = std::async(std::launch::async, [&] {
            while (const auto next = watcher.next())
                if (next->index == restart + 1) return Clock::now();
            throw std::runtime_error("the session has ended for its watcher");
        });
        if (restart % 2 == 0)
            target.reset();  // SIGKILL
        else
            target->terminate();
        std::this_thread::sleep_for(outage(restart));
        target.emplace(program, again);
        const auto back = Clock::now();
        stream.push(frame, restart + 1, 0.0);
        if (!stream.next()) throw std::runtime_error("the stream has ended");
        streams.push_back(Seconds(Clock::now() - back).count());
        watchers.push_back(Seconds(shown.get() - back).count());
    }
    return {{"until a stream was back, median of 40", median(streams), 0.5, "s"},
            {"until a stream was back, worst of 40", *std::ranges::max_element(streams), 1.5, "s"},
            {"until a watcher was back, median of 40", median(watchers), 0.5, "s"},
            {"until a watcher was back, worst of 40", *std::ranges::max_element(watchers), 1.5, "s"}};
}

}  // namespace meniscus::hostile
