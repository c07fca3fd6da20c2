// meniscus info, sessions and top against a real server; top in a terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/server.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "sample_files.hpp"
#include "terminal_program.hpp"

namespace meniscus::test {
namespace {

/// With one session that has finished two frames.
class Operators : public testing::Test {
protected:
    Operators() {
        Settings settings;
        settings.particle_radius = 0.1;
        client.create_session(id, settings);
        auto stream = client.stream(id);
        ParticleFrame frame;
        const std::vector<float> positions{0.0F, 0.0F, 0.0F, 0.1F, 0.0F, 0.0F};
        frame.positions = positions;
        for (std::uint64_t i = 0; i < 2; ++i) {
            stream.push(frame, i, 0.0);
            stream.next();
        }
        stream.finish();
        stream.next();
        while (!client.session(id).last_frame || client.session(id).last_frame_index != 1) {
        }
    }

    ProcessResult run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin() + 1, {"--server", server.address()});
        return run_process(MENISCUS_CLI, arguments);
    }

    server::ServerOptions options() const {
        server::ServerOptions options;
        options.listen = "unix:" + (directory / "socket").string();
        options.backend.threads = 1;
        options.limits.ephemeral_time = std::chrono::seconds(2);
        return options;
    }

    TemporaryDirectory directory;
    server::Server server{options()};
    client::Client client{server.address()};
    const std::string id = client::new_session_id();
};

TEST_F(Operators, SeeHealthAndLimits) {
    const ProcessResult result = run({"info"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("health                 serving\n"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("sessions               16\n"), std::string::npos) << result.out;
}

TEST_F(Operators, AskForHealthAloneAndAreToldWhatAFullServerIs) {
    const ProcessResult result = run({"info", "--health"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "health                 serving\n");
    server::ServerOptions full = options();
    full.listen = "127.0.0.1:0";
    full.limits.connections = 1;
    const server::Server other(full);
    const client::Client first(other.address());
    const ProcessResult refused = run_process(MENISCUS_CLI, {"info", "--server", other.address(), "--health"});
    EXPECT_EQ(refused.exit_code, 1) << "as when it shuts down";
    EXPECT_NE(refused.err.find("a server that is full"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("/healthz"), std::string::npos) << refused.err;
}

TEST_F(Operators, AreToldHowToGiveATokenAndWhatTheServerDoesNotOffer) {
    formats::write_file(directory / "tokens", "uploader ada 0123456789secret\n");
    std::filesystem::permissions(directory / "tokens", std::filesystem::perms::owner_read);
    server::ServerOptions guarded = options();
    guarded.listen = "127.0.0.1:0";
    guarded.tokens = (directory / "tokens").string();
    const server::Server other(guarded);
    const ProcessResult refused = run_process(MENISCUS_CLI, {"sessions", "--server", other.address()});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("asks for a token, and the call has none"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("; --token-file or MENISCUS_TOKEN gives a token\n"), std::string::npos) << refused.err;
    const ProcessResult none = run({"recordings"});
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_NE(none.err.find("meniscusd --record DIR does (not offered)\n"), std::string::npos) << none.err;
}

TEST_F(Operators, ListSessionsForPeopleAndForPrograms) {
    const ProcessResult table = run({"sessions"});
    EXPECT_EQ(table.exit_code, 0) << table.err;
    EXPECT_NE(table.out.find(id), std::string::npos) << table.out;
    const auto json = nlohmann::json::parse(run({"sessions", "--json"}).out);
    ASSERT_EQ(json.size(), 1U);
    EXPECT_EQ(json[0]["id"], id);
    EXPECT_EQ(json[0]["frames"], 2);
    EXPECT_EQ(json[0]["last_frame"]["particles"], 2);
    EXPECT_GT(json[0]["last_frame"]["latency_seconds"], 0);
}

TEST_F(Operators, SayThatThereAreNoSessions) {
    client.delete_session(id);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"sessions"}, {"top", "--interval", "0.1"}}) {
        const ProcessResult result = run(command);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(result.err, "meniscus: " + server.address() + " has no sessions\n");
    }
    EXPECT_EQ(run({"sessions", "--json"}).out, "[]\n");
}

TEST_F(Operators, MayStopWatchingASessionThatRests) {
    const ProcessResult result = run({"watch", id, "-o", (directory / "meshes").string(), "--timeout", "0.2"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("frame_000001.ply"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("meniscus: no frame of session " + id + " has come for 0.2 s (--timeout)\n"),
              std::string::npos)
        << result.err;
}

TEST_F(Operators, AreToldWhyTheSessionEndedThatTheyWatch) {
    std::jthread deleting([&](const std::stop_token& stop) {
        while (!stop.stop_requested() && client.session(id).watchers == 0) std::this_thread::yield();
        client.delete_session(id);
    });
    const ProcessResult result = run({"watch", id, "-o", (directory / "meshes").string()});
    deleting.request_stop();
    deleting.join();
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(result.err.ends_with("The session has ended: it was deleted\n")) << result.err;
}

TEST_F(Operators, EndWatchingWithTheReaderOfWhatIsSaid) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
    ::close(pipe[0]);
    const std::vector<std::string> watch{"watch",          id,   "--server",
                                         server.address(), "-o", (directory / "meshes").string()};
    EXPECT_EQ(run_process(MENISCUS_CLI, watch, {.err = pipe[1]}).exit_code, 1);
    ::close(pipe[1]);
}

TEST_F(Operators, AreToldWhereMeshesAndSprayWouldHaveOneName) {
    Settings settings;
    settings.particle_radius = 0.1;
    settings.spray = Spray::points;
    const std::string with_spray = client::new_session_id();
    client.create_session(with_spray, settings);
    auto stream = client.stream(with_spray);
    ParticleFrame frame;
    const std::vector<float> positions{0.0F, 0.0F, 0.0F};
    frame.positions = positions;
    stream.push(frame, 0, 0.0);
    ASSERT_TRUE(stream.next());
    const auto folder = directory / "meshes";
    std::filesystem::create_directory(folder);
    std::filesystem::create_symlink(folder, directory / "link");
    const auto watch = [&](const char* format) {
        return run({"watch", with_spray, "--frames", "1", "--format", format, "-o", folder.string(), "--spray-out",
                    (directory / "link").string()});
    };
    const ProcessResult refused = watch("ply");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("-o and --spray-out are one folder, '" + folder.string() + "'"), std::string::npos)
        << refused.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    EXPECT_EQ(watch("obj").exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "frame_000000.obj"));
    EXPECT_TRUE(std::filesystem::exists(folder / "frame_000000.ply"));
}

TEST_F(Operators, GetOneTableOfTopWhereThereIsNoTerminal) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, std::vector<std::string>{"--once"}}) {
        std::vector<std::string> arguments{"top", "--interval", "0.1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.out.find(id), std::string::npos) << result.out;
        EXPECT_EQ(result.out.find('\x1b'), std::string::npos) << "control sequences in a file";
    }
}

/// meniscus top, and what it draws.
class Top : public TerminalProgram {
public:
    explicit Top(const std::string& address)
        : TerminalProgram({MENISCUS_CLI, "top", "--server", address, "--interval", "0.1"}, 10, 120) {}

    void press(char key) const { EXPECT_EQ(::write(terminal(), &key, 1), 1); }
    bool echoes() const {
        termios settings{};
        ::tcgetattr(terminal(), &settings);
        return (settings.c_lflag & ECHO) != 0;
    }
};

TEST_F(Operators, WatchTopUntilTheyLeaveAndFindTheTerminalAsItWas) {
    const auto leave_by = [&](const auto& end) {
        Top top(server.address());
        const std::string drawn = top.read_until(id, 3);
        EXPECT_NE(drawn.find(id), std::string::npos) << drawn;
        EXPECT_FALSE(top.echoes());
        // Lines are replaced in place: a screen that is cleared first would flicker.
        EXPECT_EQ(drawn.find("\x1b[2J"), std::string::npos);
        end(top);
        const std::string rest = top.read_to_its_end();
        EXPECT_TRUE(rest.ends_with("\x1b[?25h\x1b[?1049l")) << "the first screen and its cursor are not back";
        EXPECT_EQ(top.exit_code(), 0);
    };
    leave_by([](const Top& top) { top.press('q'); });
    leave_by([](const Top& top) { top.press('\x03'); });
    leave_by([](const Top& top) { top.signal(SIGTERM); });
}

TEST_F(Operators, AreToldByTopThatTheServerHasGone) {
    Top top(server.address());
    top.read_until(id, 1);
    server.shutdown();
    const std::string drawn = top.read_until("is not available", 2);
    EXPECT_NE(drawn.find("is not available"), std::string::npos) << drawn;
    top.press('q');
    top.read_to_its_end();
    EXPECT_EQ(top.exit_code(), 0);
}

/// meniscus simulate, which goes on until it is ended.
class Simulate {
public:
    Simulate(const std::string& address, std::vector<std::string> more) {
        std::vector<std::string> arguments{MENISCUS_CLI, "simulate", "--particles", "200",
                                           "--frames",   "1000000",  "--server",    address};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        EXPECT_EQ(::posix_spawn(&pid_, MENISCUS_CLI, &actions, nullptr, argv.data(), environ), 0);
        posix_spawn_file_actions_destroy(&actions);
    }
    ~Simulate() {
        if (pid_ > 0) end_by(SIGKILL);
    }
    Simulate(const Simulate&) = delete;
    Simulate& operator=(const Simulate&) = delete;

    /// Returns the signal that has ended it; 0: none.
    int end_by(int signal) {
        ::kill(pid_, signal);
        int status = 0;
        ::waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }

private:
    pid_t pid_ = -1;
};

/// With a frame; none within a minute: a failure.
client::SessionInfo wait_for_session(client::Client& client, const std::string& name) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < deadline)
        for (const client::SessionInfo& session : client.sessions())
            if (session.description.name == name && session.frames > 0) return session;
    ADD_FAILURE() << "no session " << name;
    return {};
}

TEST_F(Operators, EndWhatTheyBeganWithTheCommandHoweverThatEnds) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        Simulate simulate(server.address(), {"--name", "wave pool", "--up-axis", "y", "--length-unit", "m"});
        const client::SessionInfo session = wait_for_session(client, "wave pool");
        EXPECT_TRUE(session.ephemeral);
        EXPECT_EQ(session.description.up_axis, client::UpAxis::y);
        EXPECT_EQ(session.description.length_unit, "m");
        EXPECT_EQ(simulate.end_by(signal), signal);
        EXPECT_EQ(client.sessions().size(), 1U) << "the one of the fixture";
    }
    Simulate simulate(server.address(), {"--name", "killed", "--reconnect", "0"});
    wait_for_session(client, "killed");
    EXPECT_EQ(simulate.end_by(SIGKILL), SIGKILL);
    while (client.sessions().size() > 1) std::this_thread::yield();
}

TEST_F(Operators, SendTheTimesOfASequence) {
    const std::string frame(12, '\0');  // one particle
    for (const char* name : {"f_1.xyz", "f_2.xyz"}) formats::write_file(directory / name, frame);
    EXPECT_EQ(run({"reconstruct", (directory / "f_{}.xyz").string(), "-o", (directory / "m_{}.bricks").string(), "-r",
                   "0.5", "--frame-rate", "4"})
                  .exit_code,
              0);
    for (const int number : {1, 2}) {
        const std::filesystem::path file = directory / ("m_" + std::to_string(number) + ".bricks");
        EXPECT_EQ(formats::read_bricks(file.string(), formats::read_file(file)).simulation_time, number / 4.0);
    }
}

TEST_F(Operators, KeepASessionOnlyIfTheyWishTo) {
    EXPECT_EQ(run({"simulate", "--particles", "200", "--frames", "2"}).exit_code, 0);
    EXPECT_EQ(client.sessions().size(), 1U);
    EXPECT_EQ(run({"simulate", "--particles", "200", "--frames", "2", "--keep-session", "--name", "kept"}).exit_code,
              0);
    const client::SessionInfo kept = wait_for_session(client, "kept");
    EXPECT_FALSE(kept.ephemeral);
    EXPECT_EQ(kept.frames, 2U);
    // A session that was there before is not the command's to end.
    EXPECT_EQ(run({"simulate", "--particles", "200", "--frames", "2", "--session", kept.id}).exit_code, 0);
    EXPECT_EQ(client.session(kept.id).frames, 4U);
}

TEST_F(Operators, UploadPartsWhoseMeshesAreThoseOfOneProcess) {
    const auto simulate = [&](const std::string& stats, std::vector<std::string> more) {
        std::vector<std::string> arguments{"simulate", "--particles", "300",         "--frames",
                                           "3",        "--adaptive",  "--attribute", "velocity"};
        if (!stats.empty()) arguments.insert(arguments.end(), {"--stats", (directory / stats).string()});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    };
    const auto hashes = [&](const std::string& stats) {
        std::vector<std::string> all;
        const auto read = nlohmann::json::parse(formats::read_file(directory / stats));
        for (const auto& frame : read.at("frames")) all.push_back(frame.at("mesh_sha256"));
        return all;
    };
    EXPECT_EQ(simulate("whole.json", {}).exit_code, 0);
    const std::string session = client::new_session_id();
    std::vector<std::thread> others;
    for (const char* part : {"1", "2"})
        others.emplace_back([&simulate, &session, part] {
            const ProcessResult result =
                simulate("", {"--session", session, "--parts", "3", "--part", part, "--run", "77"});
            EXPECT_EQ(result.exit_code, 0) << result.err;
        });
    const ProcessResult first = simulate("parts.json", {"--session", session, "--parts", "3", "--run", "77"});
    for (std::thread& other : others) other.join();
    EXPECT_EQ(first.exit_code, 0) << first.err;
    ASSERT_EQ(hashes("whole.json").size(), 3U);
    EXPECT_EQ(hashes("parts.json"), hashes("whole.json"));
    for (const auto& [flags, text] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--parts", "3"}, "--parts requires"},
             {{"--part", "1"}, "--part requires --parts"},
             {{"--session", session, "--parts", "3", "--part", "3", "--run", "1"}, "part is 3 of 3 parts"},
             {{"--session", session, "--parts", "3", "--part", "1", "--run", "1", "--out", "there"},
              "--out and --stats"},
             {{"--session", session, "--parts", "3", "--run", "1", "--positions", "uint16"},
              "--parts needs float32"}}) {
        const ProcessResult refused = simulate("", flags);
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_NE(refused.err.find(text), std::string::npos) << refused.err;
    }
}

TEST_F(Operators, DeleteSessionsByIdAndByNameAndAreToldOfThoseThatAreNone) {
    Settings settings;
    settings.particle_radius = 0.1;
    for (const char* name : {"one", "two", "two"})
        client.create_session(client::new_session_id(), settings, {.description = {.name = name}});
    const ProcessResult table = run({"sessions"});
    EXPECT_NE(table.out.find(" one "), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("AGE"), std::string::npos) << table.out;
    const ProcessResult result = run({"sessions", "--delete", id, "two", "one", "three"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.out.find("deleted " + id), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("2 sessions have the name \"two\"; say which by its id"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("no session has the name or id \"three\""), std::string::npos) << result.err;
    EXPECT_EQ(client.sessions().size(), 2U);
    const ProcessResult none = run({"sessions", "--delete"});
    EXPECT_EQ(none.exit_code, 2) << "an empty list is no list of all";
}

TEST_F(Operators, AreToldBeforeAnythingIsSentThatANameIsNone) {
    const ProcessResult result = run({"simulate", "--name", "a\nb", "--frames", "1"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("\\u{000a}"), std::string::npos) << result.err;
    EXPECT_EQ(run({"simulate", "--up-axis", "w", "--frames", "1"}).exit_code, 2);
    EXPECT_EQ(client.sessions().size(), 1U);
}

}  // namespace
}  // namespace meniscus::test
