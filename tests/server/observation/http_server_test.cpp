// The HTTP port: what it answers, and that nobody can keep it from answering others.
#include "web/http_server.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "connections/listen_address.hpp"
#include "meniscus/error.hpp"
#include "observation/http_client.hpp"

namespace meniscus::server::test {
namespace {

Router router() {
    Router router;
    router.add("/one", [] { return Page{.body = "1\n"}; });
    router.add("/two", [] { return Page{.body = "22\n"}; });
    router.add("/large", [] { return Page{.body = std::string(std::size_t{32} << 20, 'x')}; });
    router.add("/broken", []() -> Page { throw std::runtime_error("out of order"); });
    return router;
}

/// With clients that are soon too slow.
HttpLimits impatient() {
    return {.connections = 8,
            .header_bytes = 1024,
            .patience = std::chrono::milliseconds(200),
            .bytes_per_second = std::numeric_limits<std::uint32_t>::max()};
}

TEST(HttpServer, AnswersWhatItHasAndSaysWhatItHasNot) {
    const HttpServer server("127.0.0.1:0", router());
    HttpClient client(server.address());
    EXPECT_EQ(client.get("/one").body, "1\n");
    EXPECT_EQ(client.get("/two?anything=at%20all").body, "22\n");
    const HttpAnswer missing = client.get("/three");
    EXPECT_EQ(missing.status, 404);
    EXPECT_NE(missing.body.find("/one"), std::string::npos) << missing.body;
    EXPECT_NE(missing.header.find("Content-Type: text/plain"), std::string::npos) << missing.header;
    EXPECT_EQ(client.get("/broken").status, 500);
    EXPECT_EQ(client.get("/one").status, 200);
}

TEST(HttpServer, HasNoLimitForEachPeerOnLoopback) {
    HttpLimits limits = impatient();
    limits.patience = std::chrono::seconds(30);
    limits.connections_per_peer = 1;
    const HttpServer server("127.0.0.1:0", router(), {}, limits);
    HttpClient first(server.address());
    EXPECT_EQ(first.get("/one").status, 200);
    HttpClient second(server.address());
    EXPECT_EQ(second.get("/one").status, 200);
    EXPECT_EQ(first.get("/one").status, 200);
}

TEST(HttpServer, AnswersHeadWithTheHeaderAlone) {
    const HttpServer server("127.0.0.1:0", router());
    HttpClient client(server.address());
    client.send("HEAD /two HTTP/1.1\r\nHost: test\r\n\r\n");
    const HttpAnswer answer = client.receive(true);
    EXPECT_EQ(answer.status, 200);
    EXPECT_NE(answer.header.find("Content-Length: 3\r\n"), std::string::npos) << answer.header;
    EXPECT_EQ(client.get("/one").body, "1\n");
}

TEST(HttpServer, RefusesOtherMethodsAndBodiesAndWhatIsNotHttp) {
    const HttpServer server("127.0.0.1:0", router());
    const auto refusal = [&](const std::string& request) {
        HttpClient client(server.address());
        client.send(request);
        HttpAnswer answer = client.receive();
        EXPECT_TRUE(client.ended()) << request;
        return answer;
    };
    const HttpAnswer post =
        refusal("POST /one HTTP/1.1\r\nHost: test\r\nContent-Length: 2000000\r\n\r\n" + std::string(100'000, 'x'));
    EXPECT_EQ(post.status, 405);
    EXPECT_NE(post.header.find("Allow: GET, HEAD\r\n"), std::string::npos) << post.header;
    EXPECT_NE(post.body.find("POST"), std::string::npos) << post.body;
    EXPECT_EQ(refusal("GET /one HTTP/1.1\r\nHost: test\r\nContent-Length: 4\r\n\r\nbody").status, 413);
    EXPECT_EQ(refusal("GET /one HTTP/1.1\r\nHost: test\r\nTransfer-Encoding: chunked\r\n\r\n").status, 413);
    EXPECT_EQ(refusal("GET /one HTTP/1.1\r\n\r\n").status, 400) << "it names no host";
    EXPECT_EQ(refusal("GET /one HTTP/1.0\r\n\r\n").status, 200) << "which HTTP/1.0 does not know";
    EXPECT_EQ(refusal("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n").status, 400);
    EXPECT_EQ(refusal(std::string("\0\x16\x03\x01 hello\r\n\r\n", 14)).status, 400);
}

TEST(HttpServer, AnswersPipelinedRequestsInOrder) {
    const HttpServer server("127.0.0.1:0", router());
    HttpClient client(server.address());
    std::string requests;
    for (int i = 0; i < 500; ++i)
        requests += i % 2 == 0 ? "GET /one HTTP/1.1\r\nHost: test\r\n\r\n" : "GET /two HTTP/1.1\r\nHost: test\r\n\r\n";
    ASSERT_TRUE(client.send(requests));
    for (int i = 0; i < 500; ++i) ASSERT_EQ(client.receive().body, i % 2 == 0 ? "1\n" : "22\n") << i;
}

TEST(HttpServer, RefusesAHeaderPastItsLimit) {
    const HttpServer server("127.0.0.1:0", router(), {}, impatient());
    const auto answer_to_header_of = [&](std::size_t bytes) {
        const std::string start = "GET /one HTTP/1.1\r\nHost: test\r\nX: ";
        const std::string end = "\r\n\r\n";
        const std::string request = start + std::string(bytes - start.size() - end.size(), 'x') + end;
        HttpClient client(server.address());  // which has to send it soon
        client.send(request);
        return client.receive();
    };
    EXPECT_EQ(answer_to_header_of(1024).status, 200);
    const HttpAnswer refused = answer_to_header_of(2 * 1024);
    EXPECT_EQ(refused.status, 431);
    EXPECT_NE(refused.body.find("1024"), std::string::npos) << refused.body;
    EXPECT_EQ(answer_to_header_of(50'000'000).status, 431);
}

TEST(HttpServer, CutsOffWhoSendsHalfARequestOrByteByByte) {
    const HttpServer server("127.0.0.1:0", router(), {}, impatient());
    HttpClient half(server.address());
    half.send("GET /one HT");
    HttpClient silent(server.address());
    HttpClient slow(server.address());
    slow.send("GET /one HTTP/1.1\r\nHost: test\r\nX: ");
    std::size_t sent = 0;
    while (slow.send("x") && sent < 900) {  // below the limit of the header
        ++sent;
        ::usleep(1000);
    }
    EXPECT_LT(sent, 900U) << "each byte has bought more time";
    EXPECT_TRUE(half.ended());
    EXPECT_TRUE(silent.ended());
    EXPECT_TRUE(slow.ended());
    EXPECT_EQ(http_get(server.address(), "/one").status, 200);
}

TEST(HttpServer, CutsOffWhoDoesNotTakeTheAnswer) {
    const HttpServer server("127.0.0.1:0", router(), {}, impatient());
    HttpClient deaf(server.address());
    deaf.send("GET /large HTTP/1.1\r\nHost: test\r\n\r\n");
    EXPECT_EQ(http_get(server.address(), "/one").status, 200);
    // Until the server has given up, which is when a connection no longer takes bytes.
    while (deaf.send("GET /one HTTP/1.1\r\nHost: test\r\n\r\n")) ::usleep(1000);
    EXPECT_EQ(http_get(server.address(), "/one").status, 200);
}

TEST(HttpServer, AnswersWhoeverAsksWhileManyHoldConnections) {
    HttpLimits limits = impatient();
    limits.patience = std::chrono::hours(1);
    const HttpServer server("127.0.0.1:0", router(), {}, limits);
    HttpClient regular(server.address());
    EXPECT_EQ(regular.get("/one").status, 200);
    std::vector<std::unique_ptr<HttpClient>> idle;
    for (std::size_t i = 0; i < 200; ++i) {
        idle.push_back(std::make_unique<HttpClient>(server.address()));
        idle.back()->send("GET /one HT");
        // One that asks now and then is never the one that has been silent longest.
        ASSERT_EQ(regular.get("/one").status, 200) << i;
    }
    EXPECT_EQ(http_get(server.address(), "/two").status, 200);
    for (std::size_t i = 0; i + limits.connections < idle.size(); ++i) ASSERT_TRUE(idle[i]->ended()) << i;
}

TEST(HttpServer, EndsWithConnectionsOpen) {
    auto server = std::make_unique<HttpServer>("127.0.0.1:0", router());
    HttpClient idle(server->address());
    HttpClient half(server->address());
    half.send("GET /one HT");
    HttpClient deaf(server->address());
    deaf.send("GET /large HTTP/1.1\r\nHost: test\r\n\r\n");
    EXPECT_EQ(idle.get("/one").status, 200);
    server.reset();
    EXPECT_TRUE(idle.ended());
    EXPECT_TRUE(half.ended());
}

TEST(HttpServer, RefusesAddressesThatItCannotHave) {
    const HttpServer first("127.0.0.1:0", router());
    // Another attempt may succeed there.
    for (const std::string& address : {first.address(), std::string("198.51.100.1:80")}) {
        try {
            const HttpServer second(address, router());
            ADD_FAILURE() << address;
        } catch (const AddressUnavailable& error) {
            EXPECT_NE(std::string(error.what()).find(address), std::string::npos) << error.what();
        }
    }
    for (const std::string& address : {std::string("9464"), std::string(":9464"), std::string("127.0.0.1:"),
                                       std::string("127.0.0.1:http-of-nobody"), std::string("no such host:1")}) {
        try {
            const HttpServer second(address, router());
            ADD_FAILURE() << address;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(address), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace meniscus::server::test
