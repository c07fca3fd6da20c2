#include "connections.hpp"

#include <array>
#include <atomic>
#include <future>
#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::soak {

namespace {

void stream_and_leave(client::Client& client, bool watched) {
    Settings settings;
    settings.particle_radius = 0.1;
    const std::string session = client::new_session_id();
    client.create_session(session, settings);
    {
        auto stream = client.stream(session);
        const std::vector<float> position{0.0F, 0.0F, 0.0F};
        ParticleFrame frame;
        frame.positions = position;
        stream.push(frame, 0, 0.0);
        if (watched) client.watch(session).next();
    }
    client.delete_session(session);
}

void connect_once(const std::string& server, std::uint64_t number) {
    constexpr std::uint64_t kinds = 16;
    client::Client client(server);
    if (number % kinds == 0)
        stream_and_leave(client, false);
    else if (number % kinds == 1)
        stream_and_leave(client, true);
    else
        client.server_info();
}

}  // namespace

void connect_many(const std::string& server, std::uint64_t connections) {
    std::atomic<std::uint64_t> next{0};
    std::array<std::future<void>, 4> clients;
    for (auto& client : clients)
        client = std::async(std::launch::async, [&] {
            for (std::uint64_t number = next++; number < connections; number = next++) connect_once(server, number);
        });
    for (auto& client : clients) client.get();
}

}  // namespace meniscus::soak
