// The program: its flags, its signals, its exit codes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/client/client.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

/// meniscusd in a process of its own; what it prints is read here.
class Process {
public:
    explicit Process(std::vector<std::string> arguments) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
        arguments.insert(arguments.begin(), MENISCUSD_PATH);
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::dup2(ends[1], STDOUT_FILENO);
            ::dup2(ends[1], STDERR_FILENO);
            ::execv(MENISCUSD_PATH, argv.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        output_ = ends[0];
    }
    ~Process() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(output_);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// None at the end of the output.
    std::optional<std::string> line() {
        std::string text;
        char c = 0;
        while (::read(output_, &c, 1) == 1) {
            if (c == '\n') return text;
            text += c;
        }
        return std::nullopt;
    }
    std::string rest() {
        std::string text;
        while (const auto next = line()) text += *next + '\n';
        return text;
    }
    /// From the line that says so.
    std::string address() {
        const std::string words = "listening on ";
        while (const auto next = line()) {
            const std::size_t found = next->find(words);
            if (found == std::string::npos) continue;
            const std::size_t first = found + words.size();
            return next->substr(first, next->find(',', first) - first);
        }
        throw std::runtime_error("meniscusd does not listen");
    }
    void signal(int number) const { ::kill(pid_, number); }
    /// Of the process, which ends.
    int exit_code() {
        int status = 0;
        ::waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    pid_t pid_ = -1;
    int output_ = -1;
};

std::vector<std::string> on_free_port(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--listen", "127.0.0.1:0", "--threads", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(Meniscusd, EndsWellOnSigtermAndSigint) {
    for (const int number : {SIGTERM, SIGINT}) {
        Process process(on_free_port());
        const std::string address = process.address();
        client::Client client(address);
        EXPECT_EQ(client.server_info().threads, 2U);
        process.signal(number);
        EXPECT_NE(process.rest().find("stopped"), std::string::npos);
        EXPECT_EQ(process.exit_code(), 0);
    }
}

TEST(Meniscusd, AnswersTheFramesInFlightOnSigterm) {
    Process process(on_free_port());
    client::Client client(process.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    const Particles particles = wave(16, 0.0);
    stream.push(particles.view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    stream.push(particles.view(), 1, 0.0);
    while (client.session(id).frames < 2) {
    }
    process.signal(SIGTERM);
    const auto frame = stream.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    EXPECT_THROW(stream.next(), client::ServerError);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
}

TEST(Meniscusd, EndsWellWithAClientThatNeverReads) {
    Process process(on_free_port({"--shutdown-grace", "0.5"}));
    client::Client client(process.address());
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto watcher = client.watch(id);
    auto stream = client.stream(id, {.receive_meshes = false});
    const Particles particles = spray(12);
    for (std::uint64_t i = 0; i < 60; ++i) stream.push(particles.view(), i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    process.signal(SIGTERM);
    process.rest();
    EXPECT_EQ(process.exit_code(), 0);
}

TEST(Meniscusd, RefusesWrongFlagsInOneLine) {
    const std::vector<std::vector<std::string>> wrong{{"--nonsense"},
                                                      {"--threads", "many"},
                                                      {"--backend", "abacus"},
                                                      {"--memory-limit", "4X"},
                                                      {"--device-memory-limit", "4X"},
                                                      {"--devices", "0,two"},
                                                      {"--devices", "-1"},
                                                      {"--devices", "1000"},
                                                      {"--backend", "cpu", "--devices", "0"},
                                                      {"--max-sessions", "-1"},
                                                      {"--log-level", "loud"},
                                                      {"--listen"}};
    for (const auto& flags : wrong) {
        Process process(flags);
        const std::string output = process.rest();
        EXPECT_EQ(process.exit_code(), 2) << output;
        EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
        EXPECT_TRUE(output.starts_with("meniscusd: ")) << output;
    }
}

TEST(Meniscusd, RefusesAnAddressInUseInOneLine) {
    Process first(on_free_port());
    const std::string address = first.address();
    Process second({"--listen", address});
    const std::string output = second.rest();
    EXPECT_EQ(second.exit_code(), 2);
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
    EXPECT_NE(output.find(address), std::string::npos) << output;
}

TEST(Meniscusd, TakesLimitsWithUnits) {
    Process process(on_free_port({"--memory-limit", "4G", "--device-memory-limit", "2G", "--max-sessions", "5",
                                  "--max-watchers", "6", "--max-particles", "7"}));
    client::Client client(process.address());
    const client::ServerInfo info = client.server_info();
    EXPECT_EQ(info.max_bytes_per_session, std::uint64_t{4} << 30U);
    EXPECT_EQ(info.max_device_bytes_per_session, std::uint64_t{2} << 30U);
    EXPECT_EQ(info.max_sessions, 5U);
    EXPECT_EQ(info.max_watchers_per_session, 6U);
    EXPECT_EQ(info.max_particles_per_frame, 7U);
}

TEST(Meniscusd, TellsItsVersionAndHelp) {
    Process tells_version({"--version"});
    EXPECT_EQ(tells_version.rest(), "meniscusd " + std::string(version()) + "\n");
    EXPECT_EQ(tells_version.exit_code(), 0);
    Process help({"--help"});
    EXPECT_NE(help.rest().find("--listen"), std::string::npos);
    EXPECT_EQ(help.exit_code(), 0);
}

}  // namespace
}  // namespace meniscus::server::test
