// TLS and mutual TLS over real connections.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "security/access.hpp"
#include "security/small_file.hpp"
#include "test_certificates.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions tls_options(const TlsFiles& files) {
    ServerOptions options = test_options();
    options.listen = "127.0.0.1:0";
    options.tls = files;
    return options;
}

/// The status of a call over a channel of these credentials.
grpc::Status call(const std::string& address, const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
    const auto stub = v1::ServerService::NewStub(grpc::CreateChannel(address, credentials));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    v1::GetServerInfoResponse response;
    return stub->GetServerInfo(&context, {}, &response);
}

TEST(Tls, ServesAStreamWhoseClientTrustsTheCertificate) {
    const TestCertificates certificates;
    const Server server(tls_options(certificates.server_files()));
    client::Client client(server.address(), {.ca_file = certificates.file("ca")});
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    const Particles particles = wave(6, 0.0);
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(particles));
}

TEST(Tls, ServesAClientWithACertificateWhereOneIsAskedFor) {
    const TestCertificates certificates;
    const Server server(tls_options(certificates.mutual_files()));
    client::Client client(server.address(), {.ca_file = certificates.file("ca"),
                                             .certificate_file = certificates.file("client"),
                                             .key_file = certificates.key("client")});
    EXPECT_EQ(client.server_info().version, version());
}

TEST(Tls, RefusesClientsThatDoNotFit) {
    const TestCertificates certificates;
    certificates.issue("expired", "ca", -1);
    const Server server(tls_options(certificates.server_files()));
    const Server mutual(tls_options(certificates.mutual_files()));
    const auto trusting = [&](const std::string& ca, const std::string& own = {}) {
        return grpc::SslCredentials({.pem_root_certs = certificates.pem(ca),
                                     .pem_private_key = own.empty() ? "" : certificates.key_pem(own),
                                     .pem_cert_chain = own.empty() ? "" : certificates.pem(own)});
    };
    struct Case {
        const char* what;
        const Server& server;
        std::shared_ptr<grpc::ChannelCredentials> credentials;
        const char* words;
    };
    const std::vector<Case> cases{
        {"plain text", server, grpc::InsecureChannelCredentials(), "Socket closed"},
        {"another CA", server, trusting("other"), "certificate verify failed"},
        {"no certificate", mutual, trusting("ca"), "Socket closed"},
        {"a certificate of another CA", mutual, trusting("ca", "stranger"), "Socket closed"},
        {"an expired certificate", mutual, trusting("ca", "expired"), "Socket closed"},
    };
    for (const Case& c : cases) {
        const grpc::Status status = call(c.server.address(), c.credentials);
        EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << c.what;
        EXPECT_NE(status.error_message().find(c.words), std::string::npos) << c.what << ": " << status.error_message();
    }
    EXPECT_TRUE(call(mutual.address(), trusting("ca", "client")).ok());
}

TEST(Tls, RefusesAServerOfAnotherNameUnlessThatIsExpected) {
    const TestCertificates certificates;
    ServerOptions options = tls_options(certificates.server_files());
    const Server server(options);
    client::ConnectionOptions connection{.ca_file = certificates.file("ca"), .server_name = "example.org"};
    EXPECT_THROW(client::Client(server.address(), connection), client::ServerError);
    connection.server_name = "localhost";
    EXPECT_NO_THROW(client::Client(server.address(), connection));
}

TEST(Tls, ServesARotatedCertificateWhileAnOldStreamLives) {
    const TestCertificates certificates;
    Server server(tls_options(certificates.server_files()));
    const client::ConnectionOptions connection{.ca_file = certificates.file("ca")};
    client::Client client(server.address(), connection);
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    auto stream = client.stream(id);
    stream.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    const std::string before = certificates.serial("server");
    EXPECT_EQ(served_serial(server.address()), before);

    certificates.issue("next", "ca");
    certificates.replace("server", "next");
    server.reload();
    EXPECT_NE(certificates.serial("server"), before);
    EXPECT_EQ(served_serial(server.address()), certificates.serial("server"));
    EXPECT_EQ(client::Client(server.address(), connection).session(id).frames, 1U);
    stream.push(wave(4, 1.0).view(), 1, 0.0);
    EXPECT_EQ(stream.next()->index, 1U);
}

TEST(Tls, TrustsTheClientsOfARotatedCaAndNoOthers) {
    const TestCertificates certificates;
    Server server(tls_options(certificates.mutual_files()));
    const auto connect = [&](const std::string& own) {
        client::Client(server.address(), {.ca_file = certificates.file("other"),
                                          .certificate_file = certificates.file(own),
                                          .key_file = certificates.key(own)});
    };
    certificates.issue("next", "other");
    certificates.replace("server", "next");
    std::filesystem::copy_file(certificates.file("other"), certificates.file("ca"),
                               std::filesystem::copy_options::overwrite_existing);
    server.reload();
    EXPECT_NO_THROW(connect("stranger"));
    EXPECT_THROW(connect("client"), client::ServerError);
}

TEST(Tls, KeepsTheCertificateWhenTheNewOneCannotBeUsed) {
    const TestCertificates certificates;
    Server server(tls_options(certificates.server_files()));
    const std::string serial = certificates.serial("server");
    const std::string chain = certificates.pem("server");
    certificates.issue("expired", "ca", -1);
    for (const std::string& bad : {std::string("garbage"), std::string(), certificates.pem("client"),
                                   certificates.pem("expired"), chain.substr(0, chain.size() / 2)}) {
        certificates.folder.write("server.pem", bad);
        server.reload();
        EXPECT_EQ(served_serial(server.address()), serial) << bad;
    }
    std::filesystem::remove(certificates.file("server"));
    server.reload();
    EXPECT_EQ(served_serial(server.address()), serial);
    EXPECT_NO_THROW(client::Client(server.address(), {.ca_file = certificates.file("ca")}));
}

TEST(Certificates, TellWhenTheFirstOfThemExpires) {
    const TestCertificates certificates;
    certificates.issue("soon", "ca", 1);
    certificates.issue("late", "ca", 900);
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    constexpr std::int64_t day = 86400;
    EXPECT_NEAR(static_cast<double>(first_expiry(certificates.pem("late")) - now), 900.0 * day, 600.0);
    EXPECT_NEAR(static_cast<double>(first_expiry(certificates.pem("late") + certificates.pem("soon")) - now), 1.0 * day,
                600.0);
}

TEST(Access, TellsWhenTheFilesInUseExpire) {
    const TestCertificates certificates;
    const auto expected = [&](const char* name) { return static_cast<double>(first_expiry(certificates.pem(name))); };
    Access access(certificates.mutual_files(), "");
    EXPECT_EQ(access.expiry().server, expected("server"));
    EXPECT_EQ(access.expiry().client_ca, expected("ca"));
    certificates.issue("next", "ca", 7);
    certificates.replace("server", "next");
    access.reload();
    EXPECT_EQ(access.expiry().server, expected("server"));
    EXPECT_EQ(Access({}, "").expiry().server, std::numeric_limits<double>::infinity());
}

/// Nobody writes into it: a reader waits for ever.
TEST(Tls, DoesNotWaitForAPipeInTheCertificatesPlace) {
    const TestCertificates certificates;
    Server server(tls_options(certificates.server_files()));
    const std::string serial = certificates.serial("server");
    std::filesystem::remove(certificates.file("server"));
    ASSERT_EQ(::mkfifo(certificates.file("server").c_str(), 0600), 0);
    server.reload();
    EXPECT_EQ(served_serial(server.address()), serial);
    EXPECT_THROW(load_certificates(certificates.server_files()), InvalidInput);
    EXPECT_THROW(read_small_file("/dev/zero"), InvalidInput);
}

TEST(Certificates, AreRefusedWithTheFileAndTheReason) {
    const TestCertificates certificates;
    certificates.issue("expired", "ca", -1);
    const std::string locked = certificates.folder / "locked.key";
    output_of("openssl pkey -in " + certificates.key("server") + " -aes128 -passout pass:secret -out " + locked);
    const std::string chain = certificates.pem("server");
    const std::string damaged = certificates.folder.write(
        "damaged.pem", chain + chain.substr(0, chain.size() / 2) + "!\n-----END CERTIFICATE-----\n");
    const std::string server = certificates.file("server");
    const std::string key = certificates.key("server");
    const std::string none = certificates.folder / "none.pem";
    struct Case {
        TlsFiles files;
        std::string file;
        const char* reason;
    };
    const std::vector<Case> cases{
        {{server, "", ""}, "--tls-key", "is not given"},
        {{"", "", server}, "--tls-cert", "is not given"},
        {{none, key, ""}, none, "No such file"},
        {{certificates.folder / ".", key, ""}, certificates.folder / ".", "Is a directory"},
        {{key, key, ""}, key, "holds no certificate"},
        {{damaged, key, ""}, damaged, "certificate 2 in it is damaged"},
        {{server, server, ""}, server, "holds no private key"},
        {{server, locked, ""}, locked, "without a pass phrase"},
        {{server, certificates.key("client"), ""}, certificates.key("client"), "is not the key of the certificate"},
        {{certificates.file("expired"), certificates.key("expired"), ""}, certificates.file("expired"), "expired at"},
        {{server, key, key}, key, "holds no certificate"},
    };
    for (const Case& c : cases) {
        try {
            load_certificates(c.files);
            ADD_FAILURE() << c.reason;
        } catch (const InvalidInput& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(c.file), std::string::npos) << message;
            EXPECT_NE(message.find(c.reason), std::string::npos) << message;
        }
    }
    EXPECT_NO_THROW(load_certificates(certificates.mutual_files()));
}

TEST(Client, RefusesTlsFilesThatCannotBeUsed) {
    const TestCertificates certificates;
    const std::string ca = certificates.file("ca");
    for (const client::ConnectionOptions& options :
         {client::ConnectionOptions{.ca_file = certificates.folder / "none.pem"},
          client::ConnectionOptions{.ca_file = ca, .certificate_file = ca},
          client::ConnectionOptions{.ca_file = ca, .key_file = ca},
          client::ConnectionOptions{.certificate_file = ca, .key_file = ca}})
        EXPECT_THROW(client::Client("127.0.0.1:1", options), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
