// The work of an operator with the program: checking its settings, reading its log, replacing its secrets.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "test_certificates.hpp"
#include "test_folder.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

const char* const token = "token-of-ada-0123456789";
const std::string tokens = std::string("uploader ada ") + token + "\n";

/// Reads to the line with these words.
std::string line_with(Process& process, const std::string& words) {
    while (const auto line = process.line())
        if (line->find(words) != std::string::npos) return *line;
    throw std::runtime_error("no line with " + words);
}

TEST(Meniscusd, AcceptsTheSettingsThatItPrints) {
    const TestFolder folder;
    const TestCertificates certificates;
    Process prints({"--listen", "0.0.0.0:50051", "--tls-cert", certificates.file("server"), "--tls-key",
                    certificates.key("server"), "--tokens", folder.write("tokens", tokens), "--print-config"});
    const std::string text = prints.rest();
    EXPECT_EQ(prints.exit_code(), 0);
    EXPECT_EQ(text.find(token), std::string::npos) << "a secret";
    const std::string config = folder.write("config", text);
    Process checks({"--config", config, "--check-config"});
    EXPECT_EQ(checks.rest(), "the settings can be used\n");
    EXPECT_EQ(checks.exit_code(), 0);
}

TEST(Meniscusd, SaysALineForEachSettingThatCannotBeUsed) {
    const TestFolder folder;
    const std::string open = folder.write("tokens", tokens, 0644);
    Process checks({"--check-config", "--listen", "0.0.0.0:1", "--tokens", open, "--backend", "cpu", "--devices", "0"});
    const std::string output = checks.rest();
    EXPECT_EQ(checks.exit_code(), 2);
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 3) << output;
    for (const std::string& words : {std::string("--insecure"), "chmod 600 " + open, std::string("--devices needs")})
        EXPECT_NE(output.find(words), std::string::npos) << output;
}

TEST(Meniscusd, KeepsItsUnixSocketToItsUser) {
    const TestFolder folder;
    const std::string path = folder / "socket";
    Process process({"--listen", "unix:" + path, "--threads", "1"});
    process.address();
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0077U, 0U);
}

TEST(Meniscusd, ReadsSecretsAgainAtSighup) {
    const TestFolder folder;
    const TestCertificates certificates;
    Process process(on_free_port({"--tls-cert", certificates.file("server"), "--tls-key", certificates.key("server"),
                                  "--tokens", folder.write("tokens", tokens)}));
    const std::string address = process.address();
    certificates.issue("next", "ca");
    certificates.replace("server", "next");
    folder.write("tokens", "uploader ben token-of-ben-0123456789\n");
    process.signal(SIGHUP);
    line_with(process, "1 new tokens");
    EXPECT_EQ(served_serial(address), certificates.serial("server"));
    client::ConnectionOptions options{.ca_file = certificates.file("ca"), .token = token};
    EXPECT_THROW(client::Client(address, options).server_info(), client::ServerError);
    options.token = "token-of-ben-0123456789";
    EXPECT_EQ(client::Client(address, options).server_info().threads, 2U);
}

TEST(Meniscusd, LogsJsonWithTheSession) {
    const TestFolder folder;
    Process process(on_free_port({"--log-format", "json", "--tokens", folder.write("tokens", tokens)}));
    const nlohmann::json start = nlohmann::json::parse(line_with(process, "listening on "));
    EXPECT_EQ(start.at("level"), "info");
    EXPECT_EQ(start.at("time").get<std::string>().size(), std::string("2000-01-01T00:00:00.000Z").size());
    EXPECT_FALSE(start.contains("session"));
    const std::string message = start.at("message");
    const std::size_t first = message.find("listening on ") + std::string("listening on ").size();
    client::Client client(message.substr(first, message.find(',', first) - first), {.token = token});
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    client.delete_session(id);
    process.signal(SIGTERM);
    bool deleted = false;
    while (const auto line = process.line()) {
        const nlohmann::json entry = nlohmann::json::parse(*line);
        if (entry.at("message").get<std::string>().starts_with("deleted")) deleted = entry.at("session") == id;
        EXPECT_EQ(line->find(token), std::string::npos) << "a secret";
    }
    EXPECT_TRUE(deleted);
    EXPECT_EQ(process.exit_code(), 0);
}

TEST(Client, WaitsForAServerThatIsStillStartingIfToldTo) {
    const TestFolder folder;
    const std::string address = "unix:" + (folder / "socket");
    EXPECT_THROW(client::Client{address}, client::ServerError);
    Process process({"--listen", address, "--threads", "1"});
    EXPECT_NO_THROW(client::Client(address, {.wait = std::chrono::seconds(60)}));
}

}  // namespace
}  // namespace meniscus::server::test
