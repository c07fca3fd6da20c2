// The gRPC port: every kind of address, its limits, and how it looks after itself.
#include "connections/grpc_port.hpp"

#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <sys/eventfd.h>
#include <sys/un.h>

#include <thread>

#include "connections/attack_sockets.hpp"
#include "connections/descriptors.hpp"
#include "connections/listen_address.hpp"
#include "connections/port_check.hpp"
#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "running_server.hpp"
#include "test_certificates.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions listening_on(const std::string& address) {
    ServerOptions options = test_options();
    options.listen = address;
    options.http = "127.0.0.1:0";
    return options;
}

/// True once the check says so; false if it does not within a minute.
bool becomes(const PortCheck& check, bool answers) {
    const auto guard = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (check.answers() != answers && std::chrono::steady_clock::now() < guard) std::this_thread::yield();
    return check.answers() == answers;
}

/// Not one of loopback; empty if there is none.
std::string address_of_this_machine() {
    ifaddrs* all = nullptr;
    if (::getifaddrs(&all) != 0) return {};
    const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owned(all, ::freeifaddrs);
    for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
        if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
        const PeerAddress address(*each->ifa_addr);
        if (!address.is_this_machine()) return address.text();
    }
    return {};
}

constexpr PortCheck::Times hurried{.between = std::chrono::milliseconds(1), .patience = std::chrono::milliseconds(100)};

TEST(GrpcPort, ServesEveryKindOfAddress) {
    const TestFolder folder;
    for (const std::string& address : {std::string("127.0.0.1:0"), std::string("localhost:0"), std::string("[::1]:0"),
                                       "unix:" + folder / "socket", "unix://" + folder / "another"}) {
        RunningServer running(listening_on(address));
        EXPECT_EQ(running.client.server_info().version, version()) << address;
        EXPECT_EQ(http_get(running.server.http_address(), "/healthz").status, 200) << address;
    }
}

TEST(GrpcPort, ServesIpv4AndIpv6OnEveryAddressOfTheMachine) {
    ServerOptions options = listening_on("0.0.0.0:0");
    options.insecure = true;
    const Server server(options);
    const std::string port = server.address().substr(server.address().rfind(':'));
    EXPECT_EQ(client::Client("127.0.0.1" + port).server_info().version, version());
    EXPECT_EQ(client::Client("[::1]" + port).server_info().version, version());
}

TEST(GrpcPort, TakesThePathOfAServerThatWasKilledAndNotThatOfOneThatListens) {
    const TestFolder folder;
    const std::string address = "unix:" + folder / "socket";
    {
        RunningServer running(listening_on(address));
        EXPECT_THROW(Server{listening_on(address)}, AddressUnavailable);
        EXPECT_EQ(running.client.server_info().version, version());
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "socket"));
    // A server that is killed leaves such a socket.
    const int left_behind = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    (folder / "socket").copy(name.sun_path, sizeof name.sun_path - 1);
    ASSERT_EQ(::bind(left_behind, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    ::close(left_behind);
    RunningServer running(listening_on(address));
    EXPECT_EQ(running.client.server_info().version, version());
    folder.write("file", "no socket");
    EXPECT_THROW(Server{listening_on("unix:" + folder / "file")}, AddressUnavailable);
}

TEST(GrpcPort, RefusesAddressesThatAreNone) {
    for (const char* wrong :
         {"127.0.0.1", "127.0.0.1:", ":50051", "127.0.0.1:65536", "127.0.0.1:99999", "127.0.0.1:-1", "127.0.0.1:5x",
          "::1:50051", "[::1]", "[]:1", "dns:///localhost:1", "ipv4:127.0.0.1:1", "unix:", "unix-abstract:name"}) {
        EXPECT_THROW(require_listen_address(wrong), InvalidInput) << wrong;
        EXPECT_THROW(Server{listening_on(wrong)}, InvalidInput) << wrong;
    }
}

TEST(GrpcPort, IsRefusedWithoutAHostWithTheAddressesThatAreMeant) {
    for (const char* flag : {"--listen", "--http"}) {
        try {
            parse_host_port(flag, "50098");
            ADD_FAILURE() << "it is taken";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(error.what(), std::string(flag) +
                                        " 50098 has no host: give 127.0.0.1:50098 for this machine "
                                        "alone, or 0.0.0.0:50098 for others, too");
        }
    }
    EXPECT_EQ(problems_of(listening_on("50098")).size(), 1U);
}

TEST(GrpcPort, IsAliveWhileItIsFull) {
    const TestCertificates certificates;
    for (const TlsFiles& files : {TlsFiles{}, certificates.server_files(), certificates.mutual_files()}) {
        ServerOptions options = listening_on("127.0.0.1:0");
        options.tls = files;
        options.limits.connections = 4;
        options.probes = "127.0.0.1:0";
        const Server server(options);
        const AttackSockets strangers(server.address(), 8);
        scrape_until(server.probes_address(), "meniscus_connections_refused_total{limit=\"connections\"}", 4);
        const auto later = std::chrono::steady_clock::now() + std::chrono::seconds(4);
        while (std::chrono::steady_clock::now() < later)
            ASSERT_EQ(http_get(server.probes_address(), "/healthz").status, 200);
    }
}

TEST(GrpcPort, TakesAConnectionInThePlaceOfOneThatHasGone) {
    ServerOptions options = listening_on("127.0.0.1:0");
    options.limits.connections = 2;
    const Server server(options);
    for (int i = 0; i < 5; ++i) {
        {
            const AttackSockets strangers(server.address(), 2);
            scrape_until(server.http_address(), "meniscus_connections", 2);
        }
        scrape_until(server.http_address(), "meniscus_connections", 0);
    }
    EXPECT_EQ(client::Client(server.address()).server_info().version, version());
}

TEST(GrpcPort, BoundsTheConnectionsOfAnotherMachine) {
    const std::string host = address_of_this_machine();
    if (host.empty()) GTEST_SKIP() << "this machine has loopback alone";
    ServerOptions options = listening_on("0.0.0.0:0");
    options.insecure = true;
    options.limits.connections_per_peer = 3;
    {
        const Server server(options);
        const AttackSockets strangers(host + server.address().substr(server.address().rfind(':')), 10);
        scrape_until(server.http_address(), "meniscus_connections_refused_total{limit=\"connections_per_peer\"}", 7);
        EXPECT_EQ(
            client::Client("127.0.0.1" + server.address().substr(server.address().rfind(':'))).server_info().version,
            version());
    }
    options.trusted_proxies = {host};
    const Server server(options);
    const AttackSockets clients(host + server.address().substr(server.address().rfind(':')), 10);
    scrape_until(server.http_address(), "meniscus_connections", 10);
}

// For what is too large gRPC ends the connection, which behind a proxy is that of other clients, too.
TEST(GrpcPort, TakesMoreMetadataThanTheProxiesPassOn) {
    RunningServer running(listening_on("127.0.0.1:0"));
    const client::Connection connection(running.server.address());
    const auto call = [&](std::size_t bytes) {
        grpc::ClientContext context;
        context.AddMetadata("x-large", std::string(bytes, 'x'));
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
        v1::GetServerInfoResponse response;
        return connection.server->GetServerInfo(&context, {}, &response);
    };
    EXPECT_TRUE(call(std::size_t{48} << 10U).ok());
}

TEST(PortCheck, NoticesAPortThatDoesNotAnswerAndThatItAnswersAgain) {
    for (const auto protocol : {PortCheck::Protocol::http2, PortCheck::Protocol::tls}) {
        const ListeningSockets mute("127.0.0.1:0");
        OwnConnections own;
        const PortCheck check(mute.descriptors(), protocol, own, hurried);
        EXPECT_TRUE(check.answers());
        EXPECT_TRUE(becomes(check, false));
    }
}

TEST(PortCheck, EndsAtOnceWhileItWaitsForAnAnswer) {
    const ListeningSockets mute("127.0.0.1:0");
    OwnConnections own;
    PortCheck check(mute.descriptors(), PortCheck::Protocol::http2, own,
                    {.between = {}, .patience = std::chrono::hours(1)});
    const auto begin = std::chrono::steady_clock::now();
    check.stop();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(1));
}

PeerAddress peer(const std::string& text) {
    return PeerAddress::parse(text).value();
}

/// A descriptor that is a file of its own.
class File {
public:
    File() : descriptor_(::eventfd(0, EFD_CLOEXEC)) {}
    ~File() { ::close(descriptor_); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int get() const noexcept { return descriptor_; }

private:
    int descriptor_;
};

/// A connection of this machine, whose end is known by its descriptor.
class Pair {
public:
    Pair() { ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_); }
    ~Pair() {
        for (const int end : ends_) ::close(end);
    }
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;
    int get() const noexcept { return ends_[0]; }

private:
    int ends_[2]{};
};

using Verdict = ConnectionTable::Verdict;

TEST(ConnectionTable, BoundsWhatOneAddressHas) {
    ConnectionTable table({.all = 100, .for_each_peer = 2}, TrustedPeers({"192.0.2.0/28"}));
    std::vector<std::unique_ptr<Pair>> open;
    const auto admit = [&](const std::string& address) {
        open.push_back(std::make_unique<Pair>());
        return table.admit(open.back()->get(), peer(address));
    };
    for (const char* address : {"203.0.113.1", "203.0.113.2", "2001:db8::1"}) {
        EXPECT_EQ(admit(address), Verdict::admitted) << address;
        EXPECT_EQ(admit(address), Verdict::admitted) << address;
        EXPECT_EQ(admit(address), Verdict::too_many_of_peer) << address;
    }
    EXPECT_EQ(admit("2001:db8::2"), Verdict::too_many_of_peer);  // the same network
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(admit("192.0.2.7"), Verdict::admitted);
        EXPECT_EQ(admit("127.0.0.1"), Verdict::admitted);
    }
}

TEST(ConnectionTable, KnowsWhichConnectionsHaveGoneThoughNobodySaysSo) {
    ConnectionTable table({.all = 3, .for_each_peer = 0}, TrustedPeers());
    auto first = std::make_unique<Pair>();
    const Pair second;
    const Pair third;
    for (const Pair* each : {static_cast<const Pair*>(first.get()), &second, &third})
        EXPECT_EQ(table.admit(each->get(), peer("203.0.113.1")), Verdict::admitted);
    EXPECT_EQ(table.sweep(), 3U);
    first.reset();
    const File reuses_the_number;
    EXPECT_EQ(table.sweep(), 2U);
    const Pair next;
    EXPECT_EQ(table.admit(next.get(), peer("203.0.113.1")), Verdict::admitted);
    const Pair beyond;
    EXPECT_EQ(table.admit(beyond.get(), peer("203.0.113.1")), Verdict::too_many);
}

TEST(ConnectionShares, FitIntoTheDescriptorsWithThoseOfTheServerItself) {
    for (const std::size_t descriptors : {256, 1024, 4096, 65536}) {
        const ConnectionShares shares = share_descriptors(descriptors, 64, 0);
        EXPECT_LE(shares.grpc + shares.http + shares.probes + 64, descriptors);
        EXPECT_GE(shares.grpc, shares.http);
        EXPECT_EQ(share_descriptors(descriptors, 64, 10).grpc, 10U);
    }
    EXPECT_EQ(share_descriptors(65536, 64, 0).http, 512U);
    EXPECT_GT(share_descriptors(16, 64, 0).grpc, 0U);
}

TEST(LineLimit, LetsTheFirstLinesOfAnIntervalPassAndCountsTheOthers) {
    LineLimit limit(2, std::chrono::seconds(10));
    const LineLimit::Clock::time_point begin(std::chrono::hours(1));
    EXPECT_EQ(limit.pass(begin), 0U);
    EXPECT_EQ(limit.pass(begin), 0U);
    EXPECT_FALSE(limit.pass(begin));
    EXPECT_FALSE(limit.pass(begin + std::chrono::seconds(9)));
    EXPECT_EQ(limit.pass(begin + std::chrono::seconds(10)), 2U);
    EXPECT_EQ(limit.pass(begin + std::chrono::seconds(11)), 0U);
    EXPECT_EQ(left_out(2), " (2 lines like it were left out)");
    EXPECT_EQ(left_out(0), "");
}

}  // namespace
}  // namespace meniscus::server::test
