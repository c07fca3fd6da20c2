// Pages that may call the server, and names by which it is known.
#include "web/origins.hpp"

#include <gtest/gtest.h>

#include "meniscus/error.hpp"

namespace meniscus::server::test {
namespace {

TEST(Origins, OfThisMachineOfTheServerItselfAndOfTheListMayCall) {
    const AllowedOrigins origins({"https://viewer.example"});
    for (const char* origin : {"", "http://localhost:5173", "http://127.0.0.1", "https://[::1]:8443",
                               "https://viewer.example", "http://host:9464"})
        EXPECT_TRUE(origins.admits(origin, "host:9464")) << origin;
    for (const char* origin :
         {"null", "https://evil.example", "http://localhost.evil.example", "http://127.0.0.1.evil.example",
          "https://viewer.example.evil", "http://host:9465", "ftp://localhost"})
        EXPECT_FALSE(origins.admits(origin, "host:9464")) << origin;
    for (const char* right : {"http://10.0.0.7:8080", "https://[::1]:8443", "http://[::1]",
                              "https://xn--bcher-kva.example", "http://my_host:1"})
        EXPECT_NO_THROW(AllowedOrigins({right})) << right;
    for (const char* wrong :
         {"", "*", "viewer.example", "https://viewer.example/", "https://", "https://*.example",
          "https://a.example:", "https://a.example:0", "https://a.example:65536", "https://a.example:80:80",
          "https://[::1", "https://[::1]x", "https://[x]", "https://u@a.example", "https://a.example;script-src *",
          "https://a.example\r\nX: 1", "https://bücher.example"})
        EXPECT_THROW(AllowedOrigins({wrong}), InvalidInput) << wrong;
}

TEST(Origins, KnowTheServerByAddressAndByItsNames) {
    const AllowedOrigins origins({"https://viewer.example:8443"}, "water.example:9464");
    for (const char* host : {"", "localhost", "LocalHost:9464", "127.0.0.1:9464", "10.1.2.3", "[::1]:9464", "[fe80::1]",
                             "viewer.example", "viewer.example:1", "water.example:9464"})
        EXPECT_TRUE(origins.knows_host(host)) << host;
    for (const char* host : {"evil.example", "evil.example:9464", "127.0.0.1.evil.example", "localhost.evil.example",
                             "viewer.example.evil", "0x7f.1"})
        EXPECT_FALSE(origins.knows_host(host)) << host;
}

}  // namespace
}  // namespace meniscus::server::test
