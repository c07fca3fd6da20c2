// The HTTP port with the server's certificates.
#include <gtest/gtest.h>

#include "meniscus/v1/server_service.pb.h"
#include "running_server.hpp"
#include "test_certificates.hpp"
#include "web/web_call.hpp"

namespace meniscus::server::test {
namespace {

const std::string probe = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

ServerOptions tls_options(const TlsFiles& files) {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    options.tls = files;
    return options;
}

class WebTls : public testing::Test {
protected:
    /// The server's answer to these bytes. more: arguments of openssl s_client.
    std::string answer(const Server& server, const std::string& request, const std::string& more = "") const {
        const std::string file = certificates.folder.write("request", request);
        return output_of("openssl s_client -quiet -verify_return_error -CAfile " + certificates.file("ca") + " " +
                         more + " -connect " + server.http_address() + " <" + file + " 2>/dev/null || true");
    }
    static std::string info_call() {
        return WebCall::request("/meniscus.v1.ServerService/GetServerInfo", web_message(""), {});
    }

    const TestCertificates certificates;
};

TEST_F(WebTls, AnswersPagesAndCalls) {
    const Server server(tls_options(certificates.server_files()));
    EXPECT_NE(answer(server, probe).find("alive"), std::string::npos);
    EXPECT_NE(answer(server, info_call()).find("grpc-status: 0"), std::string::npos);
    EXPECT_EQ(answer(server, probe, "-tls1_1"), "");
}

TEST_F(WebTls, TakesNoSuiteWithoutForwardSecrecyOrWithoutAuthenticatedEncryption) {
    const Server server(tls_options(certificates.server_files()));
    const auto with = [&](const std::string& suites) {
        return answer(server, probe, "-tls1_2 -cipher '" + suites + ":@SECLEVEL=0'").find("alive") != std::string::npos;
    };
    for (const char* good :
         {"ECDHE-ECDSA-AES128-GCM-SHA256", "ECDHE-ECDSA-AES256-GCM-SHA384", "ECDHE-ECDSA-CHACHA20-POLY1305"})
        EXPECT_TRUE(with(good)) << good;
    for (const char* bad : {"ECDHE-ECDSA-AES128-SHA", "ECDHE-ECDSA-AES256-SHA384", "AES128-SHA", "AES256-GCM-SHA384",
                            "ALL:!ECDHE", "ECDHE:!AESGCM:!CHACHA20"})
        EXPECT_FALSE(with(bad)) << bad;
}

TEST_F(WebTls, TellsWhoSpeaksHttpThatTheAddressIsAnother) {
    const Server server(tls_options(certificates.server_files()));
    const HttpAnswer plain = http_get(server.http_address(), "/");
    EXPECT_EQ(plain.status, 400);
    EXPECT_NE(plain.body.find("https://"), std::string::npos) << plain.body;
}

TEST_F(WebTls, ShowsTheNewCertificateToNewConnections) {
    Server server(tls_options(certificates.server_files()));
    const std::string before = served_serial(server.http_address());
    EXPECT_EQ(before, certificates.serial("server"));
    certificates.issue("next", "ca");
    certificates.replace("server", "next");
    server.reload();
    EXPECT_EQ(served_serial(server.http_address()), certificates.serial("server"));
    EXPECT_NE(served_serial(server.http_address()), before);
}

TEST_F(WebTls, AsksCallersForACertificateWhereTheGrpcPortDoes) {
    const Server server(tls_options(certificates.mutual_files()));
    const auto shown = [&](const std::string& name) {
        return "-cert " + certificates.file(name) + " -key " + certificates.key(name);
    };
    EXPECT_NE(answer(server, probe).find("alive"), std::string::npos) << "probes have none";
    EXPECT_NE(answer(server, info_call()).find("grpc-status: 16"), std::string::npos);
    EXPECT_NE(answer(server, info_call(), shown("client")).find("grpc-status: 0"), std::string::npos);
    EXPECT_EQ(answer(server, info_call(), shown("stranger")).find("grpc-status"), std::string::npos);
}

TEST_F(WebTls, EndsWithClientsThatAreInTheMiddleOfTheHandshake) {
    Server server(tls_options(certificates.server_files()));
    HttpClient silent(server.http_address());
    HttpClient half(server.http_address());
    half.send(std::string("\x16\x03\x01\x02", 4));
    EXPECT_NE(answer(server, probe).find("alive"), std::string::npos);
    server.shutdown();
    EXPECT_TRUE(silent.ended());
    EXPECT_TRUE(half.ended());
}

}  // namespace
}  // namespace meniscus::server::test
