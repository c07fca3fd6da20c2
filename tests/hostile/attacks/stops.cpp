// SIGTERM to a server whose watchers were stalled, killed or have vanished (D7).
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

#include "../attacks.hpp"
#include "../target.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

namespace {

constexpr int times = 200;
constexpr int watchers = 6;
constexpr std::uint64_t frames = 40;

/// Processes of this one's, which go with it.
class Children {
public:
    Children() = default;
    ~Children() { kill(); }
    Children(const Children&) = delete;
    Children& operator=(const Children&) = delete;

    /// Each does its work in a process of its own: one that is stopped takes its threads with it.
    template <class Work>
    pid_t start(const Work& work) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            try {
                work();
            } catch (const std::exception&) {
                ::_exit(1);
            }
            ::_exit(0);
        }
        children_.push_back(child);
        return child;
    }
    const std::vector<pid_t>& all() const { return children_; }
    void kill() {
        for (const pid_t child : children_) ::kill(child, SIGKILL);
        for (const pid_t child : children_) ::waitpid(child, nullptr, 0);
        children_.clear();
    }

private:
    std::vector<pid_t> children_;
};

/// Throws std::runtime_error if the work fails.
template <class Work>
void in_a_process(const Work& work) {
    Children one;
    int status = 0;
    ::waitpid(one.start(work), &status, 0);
    if (status != 0) throw std::runtime_error("a client of the server has failed");
}

void watch(const std::string& address, const std::string& id) {
    client::Client client(address);
    auto watcher = client.watch(id);
    while (watcher.next()) {
    }
}

/// Particles that move far enough that every brick is sent anew.
std::vector<float> particles(std::uint64_t frame) {
    std::vector<float> positions;
    for (int x = 0; x < 24; ++x)
        for (int y = 0; y < 24; ++y)
            for (int z = 0; z < 24; ++z)
                for (const int i : {x, y, z})
                    positions.push_back(0.5F * static_cast<float>(i) + 0.03F * static_cast<float>(frame % 2));
    return positions;
}

void simulate(const std::string& address, const std::string& id, const std::vector<pid_t>& children) {
    client::Client client(address);
    for (std::size_t waited = 0; client.session(id).watchers < children.size(); ++waited)
        if (waited == 100'000) throw std::runtime_error("the watchers do not come");
    auto stream = client.stream(id, {.receive_meshes = false});
    for (std::uint64_t i = 0; i < frames; ++i) {
        if (i == frames / 4)
            for (const pid_t child : children) ::kill(child, SIGSTOP);
        const std::vector<float> positions = particles(i);
        ParticleFrame frame;
        frame.positions = positions;
        stream.push(frame, i, 0.0);
        if (!stream.next()) throw std::runtime_error("a frame has no answer");
    }
    stream.finish();
    while (stream.next()) {
    }
}

/// The state of the clients when the server gets the signal to end.
enum class Fate { stay_stopped, killed, killed_and_deleted };

double seconds_to_end(const std::string& program, Fate fate) {
    Target target(program, {.arguments = {"--shutdown-grace", "20"}, .descriptors = {}});
    const std::string id = client::new_session_id();
    // In processes: gRPC does not go along with fork().
    in_a_process([&] {
        Settings settings;
        settings.particle_radius = 0.25;
        client::Client(target.address()).create_session(id, settings);
    });
    Children watching;
    for (int i = 0; i < watchers; ++i) watching.start([&] { watch(target.address(), id); });
    in_a_process([&] {
        simulate(target.address(), id, watching.all());
        if (fate == Fate::killed_and_deleted) client::Client(target.address()).delete_session(id);
    });
    if (fate != Fate::stay_stopped) watching.kill();
    const End end = target.terminate();
    if (end.exit_code != 0) throw std::runtime_error("the server ended with " + std::to_string(end.exit_code));
    return end.seconds;
}

}  // namespace

std::vector<Figure> stops(const std::string& program) {
    double slowest = 0.0;
    for (int i = 0; i < times; ++i) slowest = std::max(slowest, seconds_to_end(program, static_cast<Fate>(i % 3)));
    return {{"from SIGTERM after the last frame to the end", slowest, 1.0, "s"}};
}

}  // namespace meniscus::hostile
