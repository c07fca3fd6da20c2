#include "connections/received_bytes.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

namespace meniscus::server {
namespace {

/// A connection that has come from this port of loopback.
void enter(ReceivedBytesOfPeers& bytes, int descriptor, std::uint16_t port) {
    sockaddr_in peer{};
    peer.sin_family = AF_INET;
    peer.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    peer.sin_port = htons(port);
    bytes.enter(descriptor, reinterpret_cast<const sockaddr&>(peer));
}

bool knows(const ReceivedBytesOfPeers& bytes, std::uint16_t port) {
    return bytes.of("ipv4:127.0.0.1:" + std::to_string(port)) != nullptr;
}

TEST(ReceivedBytes, AreForgottenOnceTheirDescriptorIsAnothers) {
    ReceivedBytesOfPeers bytes;
    enter(bytes, 10, 5000);
    EXPECT_TRUE(knows(bytes, 5000));
    EXPECT_FALSE(knows(bytes, 5001));
    enter(bytes, 10, 5001);
    EXPECT_FALSE(knows(bytes, 5000));
    EXPECT_TRUE(knows(bytes, 5001));
}

TEST(ReceivedBytes, OfAPeerThatCameAgainAreKnownOnceItsEarlierDescriptorIsAnothers) {
    ReceivedBytesOfPeers bytes;
    enter(bytes, 10, 5000);
    enter(bytes, 11, 5000);  // a file has taken 10
    enter(bytes, 10, 5001);
    EXPECT_TRUE(knows(bytes, 5000));
    EXPECT_TRUE(knows(bytes, 5001));
    enter(bytes, 11, 5002);
    EXPECT_FALSE(knows(bytes, 5000));
}

}  // namespace
}  // namespace meniscus::server
