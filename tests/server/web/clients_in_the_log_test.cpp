// The client of a call, as the log names it, where proxies and clients name one.
#include <gtest/gtest.h>

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <regex>
#include <sstream>
#include <string>

#include "meniscus/v1/surface_service.pb.h"
#include "running_server.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions with_a_viewer() {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    return options;
}

/// The log lines of a watcher by the HTTP port and one by gRPC, both of which name another client.
std::string log_of_watchers(const ServerOptions& options) {
    std::ostringstream out;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(out)));
    {
        RunningServer running(options);
        const std::string id = running.session();
        v1::WatchRequest request;
        request.set_session_id(id);
        {
            WebCall call(running.server.http_address(), "/meniscus.v1.SurfaceService/Watch", request,
                         {{"x-session-id", id}, {"x-web-peer", "somebody"}, {"X-Forwarded-For", "1.2.3.4, 192.0.2.7"}});
        }
        const client::Connection connection(running.server.address());
        grpc::ClientContext context;
        client::add_session_id(context, id);
        context.AddMetadata("x-web-peer", "ipv4:1.2.3.4:5");
        context.AddMetadata("x-forwarded-for", "1.2.3.4, 192.0.2.8");
        const auto native = connection.surfaces->Watch(&context, request);
        native->WaitForInitialMetadata();
        context.TryCancel();
        native->Finish();
    }
    spdlog::set_default_logger(before);
    return out.str();
}

TEST(ClientsInTheLog, AreThoseOfTrustedProxiesAndNoOthers) {
    ServerOptions options = with_a_viewer();
    options.listen = "127.0.0.1:0";
    options.trusted_proxies = {"127.0.0.1"};
    const std::string log = log_of_watchers(options);
    EXPECT_TRUE(std::regex_search(
        log, std::regex("watcher from 192\\.0\\.2\\.7 through ipv4:127\\.0\\.0\\.1:[0-9]+ \\(web\\) connected")))
        << log;
    EXPECT_TRUE(std::regex_search(
        log, std::regex("watcher from 192\\.0\\.2\\.8 through ipv4:127\\.0\\.0\\.1:[0-9]+ connected")))
        << log;
    EXPECT_EQ(log.find("1.2.3.4"), std::string::npos) << log;
}

TEST(ClientsInTheLog, AreThePeersWhateverTheySay) {
    const std::string log = log_of_watchers(with_a_viewer());
    EXPECT_EQ(log.find("192.0.2."), std::string::npos) << log;
    EXPECT_TRUE(std::regex_search(log, std::regex("watcher from ipv4:127\\.0\\.0\\.1:[0-9]+ \\(web\\) connected")))
        << log;
    EXPECT_TRUE(std::regex_search(log, std::regex("watcher from unix:[^\n]* connected"))) << log;
    EXPECT_EQ(log.find("1.2.3.4"), std::string::npos) << log;
    EXPECT_EQ(log.find("somebody"), std::string::npos) << log;
}

}  // namespace
}  // namespace meniscus::server::test
