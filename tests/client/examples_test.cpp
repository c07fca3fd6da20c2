// The examples do what they say: in process and through a server, in C and C++, they have the same meshes.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "../server/process.hpp"
#include "process.hpp"

namespace meniscus::test {
namespace {

using server::test::on_free_port;
using server::test::Process;

/// The output of an example, which must end well.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments = {}) {
    const ProcessResult result = run_process(program, arguments);
    EXPECT_EQ(result.exit_code, 0) << program << ": " << result.err;
    return result.out;
}

/// The hash in each line that has one.
std::vector<std::string> meshes_of(const std::string& output) {
    const std::regex hash("mesh ([0-9a-f]{64})");
    std::vector<std::string> meshes;
    for (std::sregex_iterator i(output.begin(), output.end(), hash), end; i != end; ++i) meshes.push_back((*i)[1]);
    return meshes;
}

TEST(Examples, HaveTheSameMeshesInCAndInCppInProcessAndThroughAServer) {
    Process server(on_free_port());
    const std::string address = server.address();
    const auto expected = meshes_of(output_of(MENISCUS_EXAMPLE_IN_PROCESS));
    ASSERT_EQ(expected.size(), 5U);
    EXPECT_NE(expected[0], expected[1]);
    EXPECT_EQ(meshes_of(output_of(MENISCUS_EXAMPLE_IN_PROCESS_C)), expected);
    EXPECT_EQ(meshes_of(output_of(MENISCUS_EXAMPLE_THROUGH_SERVER_C, {address})), expected);
    EXPECT_EQ(meshes_of(output_of(MENISCUS_EXAMPLE_SIMULATOR, {address, "5"})), expected);
}

TEST(Examples, TheWatcherSeesTheSimulatorsFrames) {
    Process server(on_free_port());
    const std::string address = server.address();
    // Runs for as long as its output is read.
    std::FILE* const simulator =
        ::popen(("exec " MENISCUS_EXAMPLE_SIMULATOR " " + address + " 1000000 2>&1").c_str(), "r");
    ASSERT_NE(simulator, nullptr);
    char line[256] = {};
    const bool said = std::fgets(line, sizeof line, simulator) != nullptr;
    std::smatch session;
    const std::string first = line;
    EXPECT_TRUE(said && std::regex_search(first, session, std::regex("session ([0-9a-f-]{36})"))) << first;
    std::atomic<bool> done = false;
    std::thread reader([&] {
        while (!done && std::fgets(line, sizeof line, simulator) != nullptr) continue;
    });
    if (!session.empty()) {
        const std::string seen = output_of(MENISCUS_EXAMPLE_WATCHER, {address, session[1], "3"});
        EXPECT_TRUE(std::regex_search(seen, std::regex("^(frame [0-9]+ at .* triangles, .* changed\n){3}$"))) << seen;
    }
    done = true;
    reader.join();
    ::pclose(simulator);
}

TEST(Examples, SayWhatIsWrongAndFail) {
    for (const char* const program : {MENISCUS_EXAMPLE_THROUGH_SERVER_C, MENISCUS_EXAMPLE_SIMULATOR}) {
        EXPECT_EQ(run_process(program, {}).exit_code, 2);
        const ProcessResult result = run_process(program, {"127.0.0.1:1"});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.err.find("127.0.0.1:1"), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace meniscus::test
