#include "options/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "test_folder.hpp"

namespace meniscus::server {
namespace {

/// Set while it lives.
class Variable {
public:
    Variable(std::string name, const std::string& value) : name_(std::move(name)) {
        ::setenv(name_.c_str(), value.c_str(), 1);
    }
    ~Variable() { ::unsetenv(name_.c_str()); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    std::string name_;
};

std::optional<EarlyExit> parse_into(CommandLine& command_line, const std::vector<std::string>& flags) {
    std::vector<const char*> argv{"meniscusd"};
    for (const std::string& flag : flags) argv.push_back(flag.c_str());
    return parse_command_line(static_cast<int>(argv.size()), argv.data(), command_line);
}

ServerOptions parse(const std::vector<std::string>& flags) {
    CommandLine command_line;
    const auto exit = parse_into(command_line, flags);
    EXPECT_FALSE(exit) << exit->text;
    return command_line.server;
}

/// The message that is printed instead.
std::string refusal(const std::vector<std::string>& flags) {
    CommandLine command_line;
    const auto exit = parse_into(command_line, flags);
    EXPECT_TRUE(exit && exit->code == 2);
    return exit ? exit->text : "";
}

std::string printed(std::vector<std::string> flags) {
    flags.emplace_back("--print-config");
    CommandLine command_line;
    const auto exit = parse_into(command_line, flags);
    EXPECT_TRUE(exit && exit->code == 0);
    return exit ? exit->text : "";
}

TEST(Options, NameTheirValuesInTheHelp) {
    CommandLine command_line;
    const auto exit = parse_into(command_line, {"--help"});
    ASSERT_TRUE(exit);
    for (const char* named : {"--tls-cert FILE", "--backend NAME=auto", "--devices LIST", "--memory-limit BYTES",
                              "--trusted-proxies LIST", "--record DIR"})
        EXPECT_NE(exit->text.find(named), std::string::npos) << named;
}

TEST(Options, ListDevices) {
    EXPECT_EQ(parse({"--devices", "0,3,1"}).devices, (std::vector<int>{0, 3, 1}));
    EXPECT_EQ(parse({"--devices=2", "--threads", "1"}).devices, (std::vector<int>{2}));
}

TEST(Options, UseAllDevicesWithoutALimitUnlessTold) {
    const ServerOptions options = parse({});
    EXPECT_TRUE(options.devices.empty());
    EXPECT_EQ(options.limits.device_bytes_per_session, 0U);
}

TEST(Options, LeaveAnEighthOfTheMemoryToOthersThanOneSessionUnlessTold) {
    EXPECT_EQ(parse({"--total-memory-limit", "8000"}).limits.bytes_per_session, 7000U);
    EXPECT_EQ(parse({"--total-memory-limit", "0"}).limits.bytes_per_session, 0U);
    EXPECT_EQ(parse({"--total-memory-limit", "8000", "--memory-limit", "9000"}).limits.bytes_per_session, 9000U);
    const Limits standard = parse({}).limits;
    EXPECT_EQ(standard.bytes_per_session, standard.total_bytes - standard.total_bytes / 8);
}

TEST(Options, ComeFromTheFlagThenTheEnvironmentThenTheFile) {
    const test::TestFolder folder;
    const std::string file = folder.write("config", "max-sessions = 3\n");
    for (const bool flag : {false, true})
        for (const bool environment : {false, true})
            for (const bool in_file : {false, true}) {
                std::vector<std::string> flags;
                if (flag) flags = {"--max-sessions", "1"};
                if (in_file) flags.insert(flags.end(), {"--config", file});
                std::optional<Variable> variable;
                if (environment) variable.emplace("MENISCUS_MAX_SESSIONS", "2");
                const std::uint32_t expected = flag ? 1 : environment ? 2 : in_file ? 3 : 16;
                EXPECT_EQ(parse(flags).limits.sessions, expected) << flag << environment << in_file;
            }
}

TEST(Options, OfEachKindComeFromEachSource) {
    const test::TestFolder folder;
    const std::string file = folder.write("config",
                                          "# a comment\n\n"
                                          "listen = unix:/run/with = and # in it\n"
                                          "  memory-limit=4G  \n"
                                          "devices = 1,2\n"
                                          "insecure = true\n"
                                          "shutdown-grace = 2.5\n"
                                          "backend = cuda\n");
    const ServerOptions from_file = parse({"--config", file});
    EXPECT_EQ(from_file.listen, "unix:/run/with = and # in it");
    EXPECT_EQ(from_file.limits.bytes_per_session, std::size_t{4} << 30U);
    EXPECT_EQ(from_file.devices, (std::vector<int>{1, 2}));
    EXPECT_TRUE(from_file.insecure);
    EXPECT_EQ(from_file.shutdown_grace, std::chrono::milliseconds(2500));
    EXPECT_EQ(from_file.backend.backend, Backend::cuda);

    const Variable config("MENISCUS_CONFIG", file);
    const Variable devices("MENISCUS_DEVICES", "3");
    const Variable insecure("MENISCUS_INSECURE", "false");
    const Variable empty("MENISCUS_LISTEN", "");
    const ServerOptions options = parse({"--backend", "cpu"});
    EXPECT_EQ(options.devices, (std::vector<int>{3}));
    EXPECT_FALSE(options.insecure);
    EXPECT_EQ(options.backend.backend, Backend::cpu);
    EXPECT_EQ(options.listen, from_file.listen) << "an empty variable is none";
}

TEST(Options, AreNotTheVariablesOfTheLibrariesAndTheClient) {
    const Variable instructions("MENISCUS_INSTRUCTIONS", "portable");
    const Variable program("MENISCUS_PROGRAM", "meniscus");
    const Variable catalyst("MENISCUS_CATALYST", "server=127.0.0.1:50051");
    const Variable token("MENISCUS_TOKEN", "secret");
    parse({});
}

TEST(Options, ThatAreWrongAreRefusedWithTheirSource) {
    const test::TestFolder folder;
    const std::string file = folder / "config";
    const auto with = [&](const std::string& lines) { return refusal({"--config", folder.write("config", lines)}); };
    {
        const Variable unknown("MENISCUS_LISTN", "127.0.0.1:1");
        const Variable wrong("MENISCUS_MAX_WATCHERS", "many");
        const std::string text = refusal({});
        EXPECT_NE(text.find("MENISCUS_LISTN: there is no setting of this name; --listen is near it"), std::string::npos)
            << text;
        EXPECT_NE(text.find("MENISCUS_MAX_WATCHERS: "), std::string::npos) << text;
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
    }
    const std::string text = with("listen = 127.0.0.1:1\nmax-sesions = 1\nthreads = 5000\nthreads = 1\n");
    EXPECT_NE(text.find(file + ":2: max-sesions: there is no setting of this name; --max-sessions is near it"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(file + ":3: threads: "), std::string::npos) << text;
    EXPECT_NE(text.find("5000"), std::string::npos) << text;
    EXPECT_NE(text.find(file + ":4: threads is there twice"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
    EXPECT_NE(with("print-config = true\n").find("print-config: there is no setting"), std::string::npos);
    EXPECT_NE(with("config = x\n").find("config: there is no setting"), std::string::npos);
    EXPECT_THROW(with("[limits]\n"), InvalidInput);
    EXPECT_THROW(refusal({"--config", folder / "none"}), InvalidInput);
    EXPECT_THROW(refusal({"--config", folder / "."}), InvalidInput);
}

TEST(Options, ThatAreUnknownAreRefusedInTheirOrderWithWhatWasMeant) {
    EXPECT_EQ(refusal({"--listne", "127.0.0.1:1", "--frobnicate=2", "--http", "off"}),
              "meniscusd: unknown option --listne, did you mean --listen?\n"
              "meniscusd: unknown option --frobnicate; see meniscusd --help\n");
    EXPECT_EQ(refusal({"first", "second"}),
              "meniscusd: unexpected argument 'first'; see meniscusd --help\n"
              "meniscusd: unexpected argument 'second'; see meniscusd --help\n");
}

TEST(Options, ThatAreNumbersAreRefusedWhereTheyAreNone) {
    const std::string text = refusal({"--max-frame-work", "nan", "--check-config"});
    EXPECT_NE(text.find("nan is no number from 0 to 1000000000"), std::string::npos) << text;
    const std::vector<std::string> names{"--max-sessions",
                                         "--max-watchers",
                                         "--max-connections",
                                         "--max-connections-per-peer",
                                         "--max-sessions-per-name",
                                         "--max-watchers-per-name",
                                         "--max-recording-readers",
                                         "--max-reader-pause",
                                         "--max-particles",
                                         "--max-frame-work",
                                         "--max-frame-seconds",
                                         "--max-bytes-in-flight",
                                         "--max-frames-per-second",
                                         "--max-frames-per-second-per-name",
                                         "--max-chunks",
                                         "--max-bytes-in-flight-per-name",
                                         "--max-message-bytes",
                                         "--max-upload-seconds",
                                         "--min-upload-rate",
                                         "--max-idle",
                                         "--orphan-seconds",
                                         "--memory-limit",
                                         "--total-memory-limit",
                                         "--total-device-memory-limit",
                                         "--idle-buffers",
                                         "--device-memory-limit",
                                         "--shutdown-grace",
                                         "--record-limit",
                                         "--record-attribute-bits",
                                         "--record-min-frames",
                                         "--record-max-age",
                                         "--threads",
                                         "--devices"};
    for (const std::string& name : names)
        for (const char* const value : {"nan", "inf", "-inf", "-1", "1x", "1e999", " "})
            EXPECT_NE(refusal({name + "=" + value}), "") << name << " " << value;
}

TEST(Options, OfRecordedAttributesAreBits) {
    EXPECT_EQ(parse({}).recording.attribute_bits, 8);
    EXPECT_EQ(parse({"--record-attribute-bits", "0"}).recording.attribute_bits, 0);
    EXPECT_EQ(parse({"--record-attribute-bits", "16"}).recording.attribute_bits, 16);
    EXPECT_NE(refusal({"--record-attribute-bits", "17"}), "");
}

TEST(Options, OfRecordedMeshesAreCodecsByName) {
    EXPECT_EQ(parse({}).recording.codec, Codec::lattice_entropy);
    EXPECT_EQ(parse({"--record-codec", "packed"}).recording.codec, Codec::lattice_packed);
    EXPECT_EQ(parse({"--record-codec", "draco"}).recording.codec, Codec::draco);
    EXPECT_THROW(parse({"--record-codec", "zip"}), InvalidInput);
}

TEST(Options, ThatAreTimesAreZeroOrAtLeastAMillisecond) {
    for (const char* const name : {"--max-reader-pause", "--max-frame-seconds", "--max-upload-seconds", "--max-idle",
                                   "--orphan-seconds", "--idle-buffers", "--shutdown-grace", "--record-max-age"})
        for (const char* const value : {"0.0001", "0.000999", "1e-9"}) {
            const std::string text = refusal({name, value});
            EXPECT_NE(text.find(std::string(value) + " is no number of seconds: 0, or from 0.001 to "),
                      std::string::npos)
                << text;
        }
    EXPECT_EQ(parse({"--max-idle", "0.001"}).limits.idle_time, std::chrono::milliseconds(1));
    EXPECT_EQ(parse({"--max-idle", "0"}).limits.idle_time, std::chrono::milliseconds(0));
}

TEST(Options, KeepAllRecordingsUnlessTold) {
    EXPECT_TRUE(parse({"--record", "somewhere"}).recording.retention.keeps_all());
    const RecordingRetention retention =
        parse({"--record-min-frames", "3", "--record-max-age", "2592000"}).recording.retention;
    EXPECT_EQ(retention.min_frames, 3U);
    EXPECT_EQ(retention.max_age, std::chrono::hours(30 * 24));
}

TEST(Options, HaveAViewerOnLoopbackWhereOthersCannotReachTheServerAndNothingElseIsSaid) {
    const test::TestFolder folder;
    const auto http = [](const std::vector<std::string>& flags) {
        const ServerOptions options = parse(flags);
        return options.http + (options.http_is_default ? " by default" : "");
    };
    EXPECT_EQ(http({}), "127.0.0.1:9464 by default");
    EXPECT_EQ(http({"--listen", "127.0.0.2:0"}), "127.0.0.2:9464 by default");
    EXPECT_EQ(http({"--listen", "[::1]:50051"}), "[::1]:9464 by default");
    EXPECT_EQ(http({"--listen", "localhost:50051"}), "localhost:9464 by default");
    for (const char* listen : {"unix:/run/socket", "0.0.0.0:50051", "[::]:50051", "192.0.2.7:50051", "host:50051"})
        EXPECT_EQ(parse({"--listen", listen, "--insecure"}).http, "") << listen;
    EXPECT_EQ(http({"--http", "off"}), "");
    EXPECT_EQ(http({"--http", ""}), "");
    EXPECT_EQ(http({"--config", folder.write("config", "http =\n")}), "");
    EXPECT_EQ(http({"--config", folder.write("config", "http = off\n")}), "");
    EXPECT_EQ(http({"--config", folder.write("config", "http = 127.0.0.1:80\n")}), "127.0.0.1:80");
    EXPECT_EQ(http({"--http", "127.0.0.1:81"}), "127.0.0.1:81");
    {
        const Variable variable("MENISCUS_HTTP", "127.0.0.1:82");
        EXPECT_EQ(http({}), "127.0.0.1:82");
    }
    const Variable empty("MENISCUS_HTTP", "");
    EXPECT_EQ(http({}), "127.0.0.1:9464 by default") << "an empty variable is none";
}

TEST(Options, LeaveVariablesOfOthersAlone) {
    const Variable token("MENISCUS_TOKEN", "secret");
    const Variable host("MENISCUS_SERVICE_HOST", "10.0.0.1");
    const Variable port("MENISCUS_PORT_50051_TCP", "tcp://10.0.0.1:50051");
    EXPECT_EQ(printed({}).find("secret"), std::string::npos);
}

TEST(Options, ArePrintedAsAFileThatGivesThemAgain) {
    const test::TestFolder folder;
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{},
          {"--http", ""},
          {"--http", "off"},
          {"--listen", "[::1]:0", "--devices", "0,2", "--memory-limit", "3M", "--insecure", "--shutdown-grace", "0.25",
           "--log-level", "debug", "--backend", "cpu", "--tls-cert", "a b.pem", "--tokens", "t#1"}}) {
        const std::string text = printed(flags);
        EXPECT_EQ(printed({"--config", folder.write("config", text)}), text);
    }
    const std::string text = printed({"--max-sessions", "5", "--tokens", "/etc/meniscus/tokens"});
    EXPECT_NE(text.find("\nmax-sessions = 5\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\ntokens = /etc/meniscus/tokens\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n# tls-cert =\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n# http =\n"), std::string::npos) << text;
    EXPECT_NE(printed({"--http", ""}).find("\nhttp = off\n"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::server
