#include "security/trusted_peers.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "meniscus/error.hpp"
#include "security/forwarded_client.hpp"

namespace meniscus::server::test {
namespace {

PeerAddress address(const std::string& text) {
    return PeerAddress::parse(text).value();
}

TEST(PeerAddress, IsTheSameHoweverAConnectionNamesIt) {
    EXPECT_EQ(PeerAddress::of_grpc("ipv4:192.0.2.7:50000"), address("192.0.2.7"));
    EXPECT_EQ(PeerAddress::of_grpc("ipv6:%5B::ffff:192.0.2.7%5D:50000"), address("192.0.2.7"));
    EXPECT_EQ(PeerAddress::of_grpc("ipv6:[2001:db8::1]:50000"), address("2001:db8::1"));
    EXPECT_EQ(PeerAddress::of_grpc("ipv6:%5Bfe80::1%25eth0%5D:50000"), address("fe80::1"));
    EXPECT_EQ(address("::ffff:192.0.2.7").text(), "192.0.2.7");
    EXPECT_EQ(address("2001:db8::1").text(), "2001:db8::1");
}

TEST(PeerAddress, IsThisMachineForLoopbackAndForUnixSocketsAndForThisProcess) {
    for (const char* peer : {"unix:", "unix:/run/meniscus", "inproc", "ipv4:127.8.9.1:5", "ipv6:%5B::1%5D:5"})
        EXPECT_TRUE(PeerAddress::of_grpc(peer).is_this_machine()) << peer;
    for (const char* peer : {"ipv4:128.0.0.1:5", "ipv6:%5B::2%5D:5", "ipv6:%5B2001:db8::1%5D:5"})
        EXPECT_FALSE(PeerAddress::of_grpc(peer).is_this_machine()) << peer;
}

TEST(PeerAddress, SharesItsLimitWithItsNetworkOf64BitsIfItIsIpv6) {
    EXPECT_EQ(address("2001:db8:0:1::1").share(), address("2001:db8:0:1:ffff::2").share());
    EXPECT_NE(address("2001:db8:0:1::1").share(), address("2001:db8:0:2::1").share());
    EXPECT_NE(address("192.0.2.7").share(), address("192.0.2.8").share());
}

TEST(TrustedPeers, AreLoopbackAndUnixSocketsAlways) {
    EXPECT_TRUE(TrustedPeers().is_exempt(PeerAddress{}));
    EXPECT_TRUE(TrustedPeers().is_exempt(address("127.0.0.1")));
    EXPECT_TRUE(TrustedPeers().is_exempt(address("::1")));
    EXPECT_FALSE(TrustedPeers().is_exempt(address("192.0.2.7")));
}

TEST(TrustedPeers, AreTheAddressesAndNetworksThatAreNamed) {
    const TrustedPeers trusted({"192.0.2.7", "10.16.0.0/12", "2001:db8::/33"});
    EXPECT_TRUE(trusted.is_exempt(address("192.0.2.7")));
    EXPECT_FALSE(trusted.is_exempt(address("192.0.2.6")));
    EXPECT_TRUE(trusted.is_exempt(address("10.31.255.255")));
    EXPECT_TRUE(trusted.is_exempt(address("::ffff:10.16.0.1")));
    EXPECT_FALSE(trusted.is_exempt(address("10.32.0.0")));
    EXPECT_TRUE(trusted.is_exempt(address("2001:db8:7fff::1")));
    EXPECT_FALSE(trusted.is_exempt(address("2001:db8:8000::1")));
    EXPECT_TRUE(TrustedPeers({"0.0.0.0/0"}).is_exempt(address("8.8.8.8")));
    EXPECT_FALSE(TrustedPeers({"0.0.0.0/0"}).is_exempt(address("2001:db8::1")));
}

/// "none" without one.
std::string client_of(const TrustedPeers& trusted, const std::string& peer,
                      const std::vector<std::string_view>& headers) {
    const auto client = forwarded_client(trusted, address(peer), headers);
    return client ? client->text() : "none";
}

TEST(ForwardedClient, IsTheLastAddressThatIsNoProxys) {
    const TrustedPeers trusted({"10.0.0.0/8", "2001:db8::/32"});
    const auto client = [&](const std::vector<std::string_view>& headers) {
        return client_of(trusted, "10.0.0.1", headers);
    };
    EXPECT_EQ(client({"192.0.2.7"}), "192.0.2.7");
    EXPECT_EQ(client({"1.2.3.4, 192.0.2.7"}), "192.0.2.7") << "what is before it is the client's claim";
    EXPECT_EQ(client({"1.2.3.4,192.0.2.7 , 10.0.0.2,\t2001:db8::5"}), "192.0.2.7") << "through three proxies";
    EXPECT_EQ(client({"1.2.3.4", "192.0.2.7", "10.0.0.2"}), "192.0.2.7") << "a header for each proxy";
    EXPECT_EQ(client({"10.0.0.3, 10.0.0.2"}), "10.0.0.3") << "a client among the proxies";
    EXPECT_EQ(client({"192.0.2.7:50000"}), "192.0.2.7");
    EXPECT_EQ(client({"[2001:db9::1]:50000"}), "2001:db9::1");
    EXPECT_EQ(client({"2001:db9::1"}), "2001:db9::1");
    EXPECT_EQ(client({"::ffff:192.0.2.7"}), "192.0.2.7");
}

TEST(ForwardedClient, IsNobodyWhereNoProxySaysSo) {
    const std::vector<std::string_view> headers{"192.0.2.7"};
    EXPECT_EQ(client_of(TrustedPeers({"10.0.0.0/8"}), "192.0.2.1", headers), "none");
    EXPECT_EQ(client_of(TrustedPeers(), "127.0.0.1", headers), "none") << "any program of this machine may say it";
    EXPECT_EQ(client_of(TrustedPeers({"127.0.0.1"}), "127.0.0.1", headers), "192.0.2.7");
    EXPECT_EQ(client_of(TrustedPeers({"127.0.0.1"}), "127.0.0.1", {}), "none");
}

TEST(ForwardedClient, IsAnAddressWhateverTheHeaderIs) {
    const TrustedPeers trusted({"10.0.0.0/8"});
    for (const std::string_view header : {"",
                                          " ",
                                          ",",
                                          ",,,",
                                          "unknown",
                                          "_hidden",
                                          "192.0.2",
                                          "192.0.2.7 refused",
                                          "192.0.2.7\nrefused",
                                          "[",
                                          "]",
                                          "[]",
                                          "[::1",
                                          "::1]:",
                                          ":",
                                          "::::",
                                          "192.0.2.7:80:80",
                                          "1.2.3.4 ,evil",
                                          "%5B::1%5D",
                                          "192.0.2.256"}) {
        const std::string client = client_of(trusted, "10.0.0.1", {header});
        EXPECT_TRUE(client == "none" || client == "::1") << header << ": " << client;
    }
    EXPECT_EQ(client_of(trusted, "10.0.0.1", {"evil, 10.0.0.2"}), "10.0.0.2") << "as far as it can be read";
}

TEST(TrustedPeers, RefuseWhatIsNoAddressByItsName) {
    for (const char* wrong : {"", "localhost", "192.0.2.7:80", "192.0.2.0/33", "10.0.0.0/", "10.0.0.0/8x", "::/129",
                              "300.0.0.1", "10.0.0.0/-1"}) {
        try {
            const TrustedPeers refused({wrong});
            ADD_FAILURE() << wrong;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace meniscus::server::test
