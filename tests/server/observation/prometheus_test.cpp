// A real Prometheus scrapes a real server.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "free_port.hpp"
#include "observation/http_client.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

/// Scrapes the target five times a second.
class Prometheus {
public:
    explicit Prometheus(const std::string& target)
        : folder_(std::filesystem::temp_directory_path() / ("meniscus-prometheus-" + std::to_string(::getpid()))),
          address_("127.0.0.1:" + std::to_string(free_port())) {
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "config.yml") << "global: {scrape_interval: 200ms, scrape_timeout: 200ms}\n"
                                              << "scrape_configs:\n"
                                              << "  - job_name: meniscus\n"
                                              << "    static_configs: [{targets: ['" << target << "']}]\n";
        const std::string config = "--config.file=" + (folder_ / "config.yml").string();
        const std::string storage = "--storage.tsdb.path=" + (folder_ / "data").string();
        const std::string listen = "--web.listen-address=" + address_;
        pid_ = ::fork();
        if (pid_ == 0) {
            ::execlp("prometheus", "prometheus", config.c_str(), storage.c_str(), listen.c_str(), "--log.level=error",
                     nullptr);
            ::_exit(127);
        }
    }
    ~Prometheus() {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
        std::filesystem::remove_all(folder_);
    }
    Prometheus(const Prometheus&) = delete;
    Prometheus& operator=(const Prometheus&) = delete;

    /// The answer of its API, once it contains this.
    std::string query_until(const std::string& query, const std::string& expected) const {
        const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        std::string answer;
        while (answer.find(expected) == std::string::npos && std::chrono::steady_clock::now() < guard) {
            try {
                answer = http_get(address_, "/api/v1/query?query=" + query).body;
            } catch (const std::runtime_error&) {  // not yet listening
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return answer;
    }

private:
    std::filesystem::path folder_;
    std::string address_;
    pid_t pid_ = -1;
};

TEST(Prometheus, ScrapesTheServer) {
    if (std::system("command -v prometheus >/dev/null") != 0) GTEST_SKIP() << "prometheus is not installed";
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    RunningServer running(options);
    const Prometheus prometheus(running.server.http_address());
    auto stream = running.client.stream(running.session());
    for (std::uint64_t i = 0; i < 5; ++i) {
        stream.push(wave(4, 0.0).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
    }
    const std::string up = prometheus.query_until("up", "\"1\"]");
    EXPECT_NE(up.find("\"1\"]"), std::string::npos) << up;
    const std::string frames = prometheus.query_until("meniscus_frames_total", "\"5\"]");
    EXPECT_NE(frames.find("\"5\"]"), std::string::npos) << frames;
    const std::string median =
        prometheus.query_until("histogram_quantile(0.5,sum(meniscus_frame_stage_seconds_bucket)by(le))", "\"value\"");
    EXPECT_NE(median.find("\"value\""), std::string::npos) << median;
}

}  // namespace
}  // namespace meniscus::server::test
