// An uploader and a watcher that take all that they can get, beside another uploader (D9, D10).
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "meniscus/error.hpp"

namespace meniscus::hostile {

namespace {

const std::string alices = "token-of-alice-0123456789";
const std::string bobs = "token-of-bob-0123456789";

std::string tokens_file(const Folder& folder) {
    const std::filesystem::path path = folder.path() / "tokens";
    std::ofstream(path) << "uploader alice " << alices << "\nuploader bob " << bobs << '\n';
    std::filesystem::permissions(path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    return path.string();
}

std::string create(client::Client& client) {
    std::string id = client::new_session_id();
    client.create_session(id, settings_of_attacks());
    return id;
}

int threads_of(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("Threads:")) return std::stoi(line.substr(8));
    return 0;
}

/// 1 if bob is refused a session or a frame while alice has all sessions that she can get, else 0.
int refused_to_bob(const std::string& address) {
    client::Client alice(address, {.token = alices});
    client::Client bob(address, {.token = bobs});
    std::vector<std::string> hers;
    try {
        for (;;) hers.push_back(create(alice));
    } catch (const LimitExceeded&) {
    }
    const std::vector<float> positions = block_of_particles(8);
    ParticleFrame frame;
    frame.positions = positions;
    int refused = 0;
    try {
        const std::string id = create(bob);
        auto stream = bob.stream(id, {.receive_meshes = false});
        for (std::uint64_t i = 0; i < 10; ++i) stream.push(frame, i, 0.0);
        stream.finish();
        while (stream.next()) {
        }
        bob.delete_session(id);
    } catch (const LimitExceeded&) {
        ++refused;
    }
    for (const std::string& id : hers) alice.delete_session(id);
    return refused;
}

/// Threads that 300 sessions leave behind, each deleted while its frame waits for a long one.
int threads_left_behind(const Target& target) {
    client::Client alice(target.address(), {.token = alices});
    const std::vector<float> large = block_of_particles(80);
    const std::vector<float> small = block_of_particles(2);
    ParticleFrame frame;
    frame.positions = large;
    const std::string busy = create(alice);
    auto stream = alice.stream(busy, {.receive_meshes = false});
    const int before = threads_of(target.process());
    for (std::uint64_t i = 0; i < 4; ++i) stream.push(frame, i, 0.0);
    frame.positions = small;
    int most = 0;
    for (int i = 0; i < 300; ++i) {
        try {
            const std::string id = create(alice);
            auto waiting = alice.stream(id, {.receive_meshes = false});
            waiting.push(frame, 0, 0.0);
            alice.delete_session(id);
        } catch (const LimitExceeded&) {
        }
        most = std::max(most, threads_of(target.process()) - before);
    }
    stream.finish();
    while (stream.next()) {
    }
    alice.delete_session(busy);
    return most;
}

}  // namespace

std::vector<Figure> greedy_names(const std::string& program) {
    const Folder folder;
    TargetOptions options;
    options.arguments = {"--tokens", tokens_file(folder)};
    const Target target(program, options);
    return {
        {"calls of another name refused", static_cast<double>(refused_to_bob(target.address())), 0.0, ""},
        {"threads of 300 deleted sessions, at the most", static_cast<double>(threads_left_behind(target)), 80.0, ""}};
}

}  // namespace meniscus::hostile
