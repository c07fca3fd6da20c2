// HTTP clients that drip their headers, name no host, or hold the tag of a mesh whose session was replaced (N9, N12).
#include <poll.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../raw_stream.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "observation/http_client.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;
using server::test::HttpAnswer;
using server::test::HttpClient;

constexpr int drips = 400;
constexpr const char* id = "00000000-0000-4000-8000-00000000e7a6";

/// Seconds until the last of many connections is cut that send a byte of a header every two seconds.
double seconds_of_drips(const std::string& address) {
    std::vector<std::unique_ptr<HttpClient>> open;
    open.reserve(drips);
    for (int i = 0; i < drips; ++i) open.push_back(std::make_unique<HttpClient>(address));
    const auto begin = Clock::now();
    for (const auto& each : open) each->send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Drip: ");
    while (!open.empty() && Clock::now() - begin < std::chrono::seconds(60)) {
        std::erase_if(open, [](const auto& each) { return !each->send("x"); });
        std::this_thread::sleep_for(std::chrono::seconds(2));
    }
    return open.empty() ? std::chrono::duration<double>(Clock::now() - begin).count() : 1e9;
}

/// Frame 0 of run 7, of a block.
void play(const std::string& address, std::size_t side) {
    RawStream stream(address, id, {}, 7);
    const std::vector<float> positions = block_of_particles(side);
    stream.begin(0, positions.size() / 3);
    stream.bytes({reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float)});
    stream.end_frame();
    stream.send_no_more();
    static_cast<void>(stream.finish());
}

/// 1 if a tag of a session that was deleted still stands for the mesh of the one that took its id, else 0.
int stale_meshes(const Target& target) {
    const auto ask = [&](const std::string& tag) {
        HttpClient client(target.http_address());
        client.send(std::string("GET /sessions/") + id +
                    "/latest.glb HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: " + tag + "\r\n\r\n");
        return client.receive();
    };
    client::Client client(target.address());
    std::string tag = "none";
    int stale = 0;
    for (const std::size_t side : {8, 12, 8, 12}) {
        client.create_session(id, settings_of_attacks());
        play(target.address(), side);
        const HttpAnswer answer = ask(tag);
        stale += answer.status != 200 ? 1 : 0;
        const std::size_t found = answer.header.find("ETag: ");
        if (found != std::string::npos)
            tag = answer.header.substr(found + 6, answer.header.find('\r', found) - found - 6);
        client.delete_session(id);
    }
    return stale;
}

/// 1 unless a request without a host is refused.
int answered_without_host(const std::string& address) {
    HttpClient client(address);
    client.send("GET /healthz HTTP/1.1\r\n\r\n");
    return client.receive().status == 400 ? 0 : 1;
}

}  // namespace

std::vector<Figure> http_clients(const std::string& program) {
    const Target target(program);
    return {{"meshes of 4 sessions of one id for which an earlier one's tag stood",
             static_cast<double>(stale_meshes(target)), 0.0, ""},
            {"requests without a host answered", static_cast<double>(answered_without_host(target.http_address())), 0.0,
             ""},
            {"until 400 connections are cut that drip a header", seconds_of_drips(target.http_address()), 36.0, "s"}};
}

}  // namespace meniscus::hostile
