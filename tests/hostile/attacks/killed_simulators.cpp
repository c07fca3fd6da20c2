// Simulators that are killed at random moments, or leave while they are owed answers: their sessions go (N2).
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "../attacks.hpp"
#include "../raw_stream.hpp"
#include "../recorded_session.hpp"
#include "../target.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kills = 100;  ///< under each policy
constexpr int at_a_time = 10;
constexpr double orphan_seconds = 3.0;
constexpr std::array policies{"every-frame", "latest", "every-nth"};

/// meniscus simulate in a process of its own, until it is killed.
class Simulator {
public:
    Simulator(const std::string& program, const std::string& address, const std::string& session,
              const std::string& policy) {
        std::vector<std::string> words{program,          "simulate", "--particles", "4000",      "--frames",
                                       "1000000",        "--server", address,       "--session", session,
                                       "--keep-session", "--policy", policy};
        if (policy == "every-nth") words.insert(words.end(), {"--nth", "2"});
        std::vector<char*> argv;
        argv.reserve(words.size() + 1);
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        process_ = ::fork();
        if (process_ != 0) return;
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
        ::execv(argv.front(), argv.data());
        ::_exit(127);
    }
    ~Simulator() {
        if (process_ <= 0) return;
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    Simulator(const Simulator&) = delete;
    Simulator& operator=(const Simulator&) = delete;

private:
    pid_t process_ = -1;
};

int left_after_a_while(client::Client& client) {
    const auto give_up = Clock::now() + std::chrono::duration<double>(2 * orphan_seconds + 2.0);
    std::size_t left = 0;
    do {
        std::this_thread::sleep_for(milliseconds(50));
        left = client.sessions().size();
    } while (left != 0 && Clock::now() < give_up);
    return static_cast<int>(left);
}

/// Sessions that are left of simulators that are killed up to a second after their start.
int left_by_killed(const std::string& simulator, const Target& target, const std::string& policy, unsigned seed) {
    std::mt19937 random(seed);
    client::Client client(target.address());
    for (int killed = 0; killed < kills; killed += at_a_time) {
        std::vector<std::unique_ptr<Simulator>> running;
        running.reserve(at_a_time);
        for (int i = 0; i < at_a_time; ++i)
            running.push_back(
                std::make_unique<Simulator>(simulator, target.address(), client::new_session_id(), policy));
        while (!running.empty()) {
            std::this_thread::sleep_for(milliseconds(random() % (2000 / at_a_time)));
            running.pop_back();
        }
    }
    const int left = left_after_a_while(client);
    for (const client::SessionInfo& session : client.sessions()) client.delete_session(session.id);
    return left;
}

/// The same of simulators that say that nothing follows, and are gone before they have their answers.
int left_by_those_who_leave(const Target& target) {
    client::Client client(target.address());
    const std::vector<float> positions = block_of_particles(40);
    Settings slow = settings_of_attacks();
    slow.cell_size = 0.05;
    for (int i = 0; i < at_a_time; ++i) {
        const std::string id = client::new_session_id();
        client.create_session(id, slow);
        RawStream stream(target.address(), id);
        stream.begin(0, positions.size() / 3);
        stream.bytes({reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float)});
        stream.end_frame();
        stream.send_no_more();
        // The server knows that nothing follows.
        while (client.session(id).uploading) std::this_thread::yield();
        stream.cancel();
        static_cast<void>(stream.finish());
    }
    return left_after_a_while(client);
}

}  // namespace

std::vector<Figure> killed_simulators(const std::string& program) {
    // Beside the server in a build folder.
    const std::filesystem::path folder = std::filesystem::path(program).parent_path().parent_path();
    const std::string simulator = (folder / "client" / "cli" / "meniscus").string();
    TargetOptions options;
    options.arguments = {"--orphan-seconds", std::to_string(orphan_seconds), "--max-sessions", "300"};
    const Target target(program, options);
    std::vector<Figure> figures;
    for (std::size_t i = 0; i < policies.size(); ++i)
        figures.push_back(
            {"sessions left of 100 simulators that were killed, " + std::string(policies[i]),
             static_cast<double>(left_by_killed(simulator, target, policies[i], static_cast<unsigned>(i))), 0.0, ""});
    figures.push_back({"sessions left of 10 simulators that left before their answers",
                       static_cast<double>(left_by_those_who_leave(target)), 0.0, ""});
    return figures;
}

}  // namespace meniscus::hostile
