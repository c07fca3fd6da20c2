#include "daemon/server.hpp"

#include <gtest/gtest.h>

#include "connections/listen_address.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

TEST(Server, TakesAFreePortAndNamesIt) {
    ServerOptions options = test_options();
    options.listen = "127.0.0.1:0";
    RunningServer running(options);
    EXPECT_TRUE(running.server.address().starts_with("127.0.0.1:"));
    EXPECT_FALSE(running.server.address().ends_with(":0"));
    EXPECT_EQ(running.client.server_info().version, version());
}

TEST(Server, RefusesAnAddressInUse) {
    ServerOptions options = test_options();
    options.listen = "127.0.0.1:0";
    const Server tcp(options);
    options.listen = tcp.address();
    EXPECT_THROW(Server{options}, AddressUnavailable);
    const ServerOptions unix_options = test_options();
    const Server unix_socket(unix_options);
    EXPECT_THROW(Server{unix_options}, AddressUnavailable);
}

TEST(Server, RefusesAnAddressThatIsNone) {
    ServerOptions options = test_options();
    options.listen = "unix:" + std::string(300, 'x');
    EXPECT_THROW(Server{options}, InvalidInput);
}

TEST(Client, SaysThatThereIsNoServer) {
    const auto connect = [] { const client::Client client("127.0.0.1:1"); };
    try {
        connect();
        FAIL();
    } catch (const client::ServerError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with("no server at 127.0.0.1:1 (")) << message;
        EXPECT_TRUE(message.ends_with("): start meniscusd, or check the address and whether it wants TLS")) << message;
    }
}

}  // namespace
}  // namespace meniscus::server::test
