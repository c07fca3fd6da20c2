// Tokens: the rights that each role has.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "address/default_port.hpp"
#include "address/loopback.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"
#include "security/authorizer.hpp"
#include "security/tokens.hpp"
#include "test_certificates.hpp"

namespace meniscus::server::test {
namespace {

const std::string ada = "token-of-ada-0123456789";
const std::string ben = "token-of-ben-0123456789";
const std::string eve = "token-of-eve-0123456789";
const std::string root = "token-of-root-0123456789";

const char* const file_text =
    "# role name token\n"
    "uploader ada token-of-ada-0123456789\n"
    "\n"
    "  uploader\tben  token-of-ben-0123456789\n"
    "watcher eve token-of-eve-0123456789\n"
    "admin root token-of-root-0123456789\n";

/// A server that asks for tokens, and a session of ada's with a mesh, frame 0.
class TokensOnAServer : public testing::Test {
protected:
    TokensOnAServer() {
        client::Client ours = client(ada);
        ours.create_session(id, settings());
        auto stream = ours.stream(id);
        stream.push(wave(4, 0.0).view(), 0, 0.0);
        stream.finish();
        while (stream.next()) {
        }
    }

    client::Client client(const std::string& token) const { return client::Client(server.address(), {.token = token}); }

    static ServerOptions options(const std::string& file) {
        ServerOptions options = test_options();
        options.tokens = file;
        return options;
    }

    const TestFolder folder;
    const std::string file = folder.write("tokens", file_text);
    Server server{options(file)};
    const std::string id = client::new_session_id();
};

/// The calls about a session, with metadata as given.
class RawCalls {
public:
    RawCalls(const std::string& address, std::string session, std::vector<std::string> authorization)
        : connection_(address), session_(std::move(session)), authorization_(std::move(authorization)) {}

    grpc::Status server_info() const {
        v1::GetServerInfoResponse response;
        return connection_.server->GetServerInfo(context().get(), {}, &response);
    }
    grpc::Status list() const {
        v1::ListSessionsResponse response;
        return connection_.sessions->ListSessions(context().get(), {}, &response);
    }
    grpc::Status get() const {
        v1::GetSessionRequest request;
        request.set_id(session_);
        v1::GetSessionResponse response;
        return connection_.sessions->GetSession(context().get(), request, &response);
    }
    grpc::Status create(const Settings& chosen = settings()) const {
        v1::CreateSessionRequest request;
        request.set_id(session_);
        *request.mutable_settings() = conversion::to_wire(chosen);
        v1::CreateSessionResponse response;
        return connection_.sessions->CreateSession(context().get(), request, &response);
    }
    grpc::Status remove() const {
        v1::DeleteSessionRequest request;
        request.set_id(session_);
        v1::DeleteSessionResponse response;
        return connection_.sessions->DeleteSession(context().get(), request, &response);
    }
    /// Opens a stream and ends it.
    grpc::Status stream() const {
        const auto with = context();
        const auto call = connection_.surfaces->Stream(with.get());
        v1::StreamRequest open;
        open.mutable_open()->set_session_id(session_);
        call->Write(open);
        call->WritesDone();
        return call->Finish();
    }
    grpc::Status watch() const { return first_answer(&v1::SurfaceService::Stub::Watch); }
    grpc::Status watch_particles() const { return first_answer(&v1::SurfaceService::Stub::WatchParticles); }

private:
    /// OK once a message comes.
    template <class Request, class Response>
    grpc::Status first_answer(std::unique_ptr<grpc::ClientReader<Response>> (v1::SurfaceService::Stub::*method)(
        grpc::ClientContext*, const Request&)) const {
        const auto with = context();
        Request request;
        request.set_session_id(session_);
        const auto call = ((*connection_.surfaces).*method)(with.get(), request);
        Response response;
        if (!call->Read(&response)) return call->Finish();
        with->TryCancel();
        while (call->Read(&response)) {
        }
        call->Finish();
        return grpc::Status::OK;
    }

    std::unique_ptr<grpc::ClientContext> context() const {
        auto context = std::make_unique<grpc::ClientContext>();
        client::add_session_id(*context, session_);
        for (const std::string& value : authorization_) context->AddMetadata("authorization", value);
        return context;
    }

    client::Connection connection_;
    std::string session_;
    std::vector<std::string> authorization_;
};

TEST_F(TokensOnAServer, AreAskedForByEveryCall) {
    struct Case {
        std::vector<std::string> authorization;
        const char* words;
    };
    const std::vector<Case> cases{
        {{}, "this server asks for a token, and the call has none"},
        {{"Bearer " + ada, "Bearer " + ada}, "this server asks for a token, and the call has 2"},
        {{"Bearer wrong"}, "none of this server's"},
        {{"Bearer " + ada + "0"}, "none of this server's"},
        {{"Bearer " + ada.substr(1)}, "none of this server's"},
        {{"Bearer "}, "none of this server's"},
        {{"Basic " + ada}, "must be: Bearer TOKEN"},
        {{ada}, "must be: Bearer TOKEN"},
    };
    for (const Case& c : cases) {
        const RawCalls calls(server.address(), id, c.authorization);
        for (const grpc::Status& status : {calls.server_info(), calls.list(), calls.get(), calls.create(),
                                           calls.stream(), calls.watch(), calls.watch_particles(), calls.remove()}) {
            EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED);
            EXPECT_NE(status.error_message().find(c.words), std::string::npos) << status.error_message();
            EXPECT_EQ(status.error_message().find(ada), std::string::npos) << "a token in a message";
        }
    }
    EXPECT_TRUE(RawCalls(server.address(), id, {"bearer " + ada}).get().ok()) << "the scheme has no case";
}

TEST_F(TokensOnAServer, LetWatchersOnlyLook) {
    const RawCalls calls(server.address(), id, {"Bearer " + eve});
    for (const grpc::Status& status :
         {calls.server_info(), calls.list(), calls.get(), calls.watch(), calls.watch_particles()})
        EXPECT_TRUE(status.ok()) << status.error_message();
    for (const auto& [status, name] : {std::pair{calls.create(), "CreateSession"}, std::pair{calls.stream(), "Stream"},
                                       std::pair{calls.remove(), "DeleteSession"}}) {
        EXPECT_EQ(status.error_code(), grpc::StatusCode::PERMISSION_DENIED);
        EXPECT_EQ(status.error_message(), std::string(name) +
                                              " needs a token of the role uploader or admin; that of eve has the "
                                              "role watcher");
    }
    EXPECT_EQ(client(eve).sessions().size(), 1U);
}

TEST_F(TokensOnAServer, KeepUploadersFromEachOthersSessions) {
    const RawCalls calls(server.address(), id, {"Bearer " + ben});
    EXPECT_TRUE(calls.server_info().ok());
    for (const grpc::Status& status :
         {calls.get(), calls.stream(), calls.watch(), calls.watch_particles(), calls.remove()}) {
        EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
        EXPECT_EQ(status.error_message(), "no session " + id);
    }
    EXPECT_TRUE(client(ben).sessions().empty());
    EXPECT_EQ(client(ada).sessions().size(), 1U);
}

TEST_F(TokensOnAServer, TellUploadersNothingOfEachOthersSessions) {
    const std::string none = client::new_session_id();
    const RawCalls others(server.address(), id, {"Bearer " + ben});
    const RawCalls nobodys(server.address(), none, {"Bearer " + ben});
    const auto same_but_for_the_id = [&](const grpc::Status& of_others, const grpc::Status& of_nobodys) {
        EXPECT_EQ(of_others.error_code(), of_nobodys.error_code());
        std::string text = of_others.error_message();
        const std::size_t at = text.find(id);
        ASSERT_NE(at, std::string::npos) << text;
        EXPECT_EQ(text.replace(at, id.size(), none), of_nobodys.error_message());
    };
    same_but_for_the_id(others.get(), nobodys.get());
    same_but_for_the_id(others.stream(), nobodys.stream());
    same_but_for_the_id(others.watch(), nobodys.watch());
    same_but_for_the_id(others.watch_particles(), nobodys.watch_particles());
    same_but_for_the_id(others.remove(), nobodys.remove());
    // That the id is taken cannot be hidden. With which settings can.
    Settings other_settings = settings();
    other_settings.iso = 0.5;
    const grpc::Status equal = others.create();
    const grpc::Status different = others.create(other_settings);
    EXPECT_EQ(equal.error_code(), grpc::StatusCode::PERMISSION_DENIED);
    EXPECT_EQ(equal.error_code(), different.error_code());
    EXPECT_EQ(equal.error_message(), different.error_message());
}

TEST_F(TokensOnAServer, HaveSharesThatLeaveRoomForOthers) {
    folder.write("tokens",
                 "uploader ada token-of-ada-0123456789 sessions=2 watchers=1 frames-per-second=3 bytes-in-flight=1K\n"
                 "uploader ben token-of-ben-0123456789\n");
    Server shared{options(file)};
    client::Client adas(shared.address(), {.token = ada});
    client::Client bens(shared.address(), {.token = ben});
    const auto status_of = [](const auto& call) -> std::string {
        try {
            call();
            return "OK";
        } catch (const LimitExceeded& error) {
            return error.what();
        }
    };
    const auto create = [&](client::Client& client) {
        std::string session = client::new_session_id();
        client.create_session(session, settings());
        return session;
    };
    const std::string session = create(adas);
    create(adas);
    EXPECT_NE(status_of([&] { create(adas); }).find("ada has 2 sessions"), std::string::npos);
    const std::string bens_session = create(bens);

    const auto frame = [&](client::Client& client, const std::string& to, std::uint64_t frames, std::size_t side) {
        auto stream = client.stream(to);
        for (std::uint64_t i = 0; i < frames; ++i) stream.push(wave(side, 0.0).view(), i, 0.0);
        stream.finish();
        while (stream.next()) {
        }
    };
    EXPECT_NE(status_of([&] { frame(adas, session, 300, 2); }).find("more than 3 frames in a second"),
              std::string::npos);
    EXPECT_NE(status_of([&] { frame(adas, session, 1, 5); }), "OK") << "1500 bytes";
    EXPECT_EQ(status_of([&] { frame(bens, bens_session, 30, 5); }), "OK");

    const auto watcher = adas.watch(session);
    EXPECT_NE(status_of([&] { adas.watch(session).next(); }).find("ada has 1 watchers"), std::string::npos);
}

TEST_F(TokensOnAServer, LetUploadersDoEverythingWithTheirOwn) {
    const RawCalls calls(server.address(), id, {"Bearer " + ada});
    for (const grpc::Status& status :
         {calls.get(), calls.create(), calls.stream(), calls.watch(), calls.watch_particles(), calls.remove()})
        EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(TokensOnAServer, LetAdminsDoEverythingWithAll) {
    const RawCalls calls(server.address(), id, {"Bearer " + root});
    for (const grpc::Status& status :
         {calls.get(), calls.create(), calls.stream(), calls.watch(), calls.watch_particles(), calls.remove()})
        EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(TokensOnAServer, NameTheOwnerOfASession) {
    const client::Connection connection(server.address(), {.token = eve});
    grpc::ClientContext context;
    connection.add_metadata(context, {});
    v1::ListSessionsResponse response;
    ASSERT_TRUE(connection.sessions->ListSessions(&context, {}, &response).ok());
    EXPECT_EQ(response.sessions(0).owner(), "ada");
}

TEST_F(TokensOnAServer, TravelWithEveryCallOfTheLibrary) {
    client::Client ours = client(ada);
    EXPECT_EQ(ours.session(id).frames, 1U);
    auto watcher = ours.watch(id);
    EXPECT_EQ(watcher.next()->index, 0U);
    auto stream = ours.stream(id);
    stream.push(wave(4, 0.0).view(), 3, 0.0);
    EXPECT_EQ(stream.next()->index, 3U);
    EXPECT_EQ(watcher.next()->index, 3U);
    stream.finish();
    EXPECT_FALSE(stream.next());
    ours.delete_session(id);
}

TEST_F(TokensOnAServer, AreReadAgainWithoutEndingStreams) {
    client::Client ours = client(ada);
    auto stream = ours.stream(id);
    stream.push(wave(4, 0.0).view(), 1, 0.0);
    ASSERT_TRUE(stream.next());
    folder.write("tokens", "uploader ada another-token-of-ada\n");
    server.reload();
    EXPECT_THROW(ours.session(id), client::ServerError);
    EXPECT_EQ(client("another-token-of-ada").session(id).frames, 2U) << "a new token of that name has its sessions";
    stream.push(wave(4, 0.0).view(), 2, 0.0);
    EXPECT_TRUE(stream.next());
    for (const char* bad : {"", "nonsense", "uploader ada short"}) {
        folder.write("tokens", bad);
        server.reload();
        EXPECT_NO_THROW(client("another-token-of-ada").session(id)) << bad;
    }
}

TEST(Tokens, AreRefusedWithTheLineAndWithoutTheToken) {
    using std::string_literals::operator""s;
    struct Case {
        std::string text;
        const char* words;
    };
    const TestFolder folder;
    const std::vector<Case> cases{
        {"uploader ada 0123456789secret\nwatcher eve\n", ":2: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret more\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret sessions=\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret sessions=-1\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret sessions=4M\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret watchers=4294967296\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret bytes-in-flight=99999999999T\n", ":1: a line must be: ROLE NAME TOKEN"},
        {"uploader ada 0123456789secret sessions=1\nuploader ada 9876543210secret sessions=2\n",
         ":2: the shares of ada differ"},
        {"uploader ada 0123456789secret sessions=1 watchers=1 sessions=5\n", ":1: sessions is given twice"},
        {"uploader ada 0123456789secret watchers=1 watchers=1\n", ":1: watchers is given twice"},
        {"uploader a\0da 0123456789secret\n"s, ":1: the name has a control character, 0x00, behind 1 others"},
        {"# one\nuploader \x1b[2Jada 0123456789secret\n", ":2: the name has a control character, 0x1b"},
        {"uploader ada\x7f 0123456789secret\n", ":1: the name has a control character, 0x7f"},
        {"owner ada 0123456789secret\n",
         ":1: a line must be: ROLE NAME TOKEN; its role must be uploader, publisher, watcher or admin"},
        {"# only\nuploader ada 56789secret\n", ":2: the token has 11 characters; it needs at least 16"},
        {"uploader 0123456789secret ada\n", ":1: the token has 3 characters"},
        {"uploader ada 0123456789secret\nadmin eve 0123456789secret\n", ":2: the token is there twice"},
        {"# none\n", "has no tokens"},
    };
    for (const Case& c : cases) {
        try {
            Tokens::load(folder.write("tokens", c.text));
            ADD_FAILURE() << c.text;
        } catch (const InvalidInput& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(c.words), std::string::npos) << message;
            EXPECT_EQ(message.find("secret"), std::string::npos) << message;
        }
    }
}

TEST(Tokens, HaveNamesOfAllLanguages) {
    const TestFolder folder;
    const Tokens tokens = Tokens::load(folder.write("tokens", "uploader Jürgen-Ōé-水 0123456789secret\r\n"));
    EXPECT_EQ(tokens.find("0123456789secret")->name, "Jürgen-Ōé-水");
}

TEST(Tokens, HaveTheSharesOfTheirName) {
    const TestFolder folder;
    const Tokens tokens = Tokens::load(
        folder.write("tokens",
                     "uploader ada 0123456789-first\n"
                     "uploader ada 0123456789second sessions=0 watchers=7 frames-per-second=8 bytes-in-flight=9M\n"
                     "uploader ben 0123456789-third bytes-in-flight=10\n"));
    const NameShares everybody{.sessions = 1, .watchers = 2, .frames_per_second = 3, .bytes_in_flight = 4};
    const NameShares adas{
        .sessions = 0, .watchers = 7, .frames_per_second = 8, .bytes_in_flight = std::size_t{9} << 20U};
    EXPECT_EQ(tokens.find("0123456789-first")->shares.over(everybody), adas);
    EXPECT_EQ(tokens.find("0123456789second")->shares.over(everybody), adas);
    EXPECT_EQ(tokens.find("0123456789-third")->shares.over(everybody),
              (NameShares{.sessions = 1, .watchers = 2, .frames_per_second = 3, .bytes_in_flight = 10}));
}

TEST(Shares, WithoutTokensAreOfPeerAddressesThatAreNotTrusted) {
    const Authorizer authorizer{TrustedPeers({"192.0.2.0/24"})};
    const auto account = [&](const char* peer) {
        return authorizer.admit({}, PeerAddress::of_grpc(peer), Action::create_session).account;
    };
    EXPECT_EQ(account("ipv4:198.51.100.7:50000"), "198.51.100.7");
    EXPECT_EQ(account("ipv4:198.51.100.7:50001"), "198.51.100.7");
    for (const char* exempt : {"ipv4:192.0.2.1:1", "ipv4:127.0.0.1:1", "unix:", "inproc"})
        EXPECT_EQ(account(exempt), "") << exempt;
}

TEST(Tokens, AreRefusedInAFileThatEveryoneMayRead) {
    const TestFolder folder;
    for (const int mode : {0644, 0604, 0602}) {
        const std::string path = folder.write("tokens", file_text, mode);
        try {
            Tokens::load(path);
            ADD_FAILURE() << mode;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find("chmod 600 " + path), std::string::npos) << error.what();
        }
    }
    EXPECT_EQ(Tokens::load(folder.write("tokens", file_text, 0640)).size(), 4U);
}

TEST(TokenDigests, AreSha256) {
    const TokenDigest abc{0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea, 0x41, 0x41, 0x40,
                          0xde, 0x5d, 0xae, 0x22, 0x23, 0xb0, 0x03, 0x61, 0xa3, 0x96, 0x17,
                          0x7a, 0x9c, 0xb4, 0x10, 0xff, 0x61, 0xf2, 0x00, 0x15, 0xad};
    EXPECT_EQ(digest_of("abc"), abc);
}

TEST(TokenDigests, AreEqualInAllBytesOrNotAtAll) {
    const TokenDigest digest = digest_of("abc");
    EXPECT_TRUE(equal(digest, digest_of("abc")));
    for (std::size_t i = 0; i < digest.size(); ++i) {
        TokenDigest other = digest;
        other[i] ^= 1U;
        EXPECT_FALSE(equal(digest, other)) << i;
    }
}

TEST(Loopback, IsWhatNoOtherMachineReaches) {
    for (const char* address : {"localhost:1", "127.0.0.1:50051", "127.9.8.7:0", "[::1]:1", "unix:/run/meniscus"})
        EXPECT_TRUE(address::is_loopback(address)) << address;
    for (const char* address :
         {"0.0.0.0:1", "[::]:1", "128.0.0.1:1", "10.0.0.1:1", "example.org:1", "127.0.0.1.example.org:1",
          "localhost.example.org:1", "127.1:1", ":1", "", "ipv4:127.0.0.1:1", "dns:///localhost:1"})
        EXPECT_FALSE(address::is_loopback(address)) << address;
}

TEST(DefaultPort, StandsBehindAHostAloneAndNothingElse) {
    EXPECT_EQ(address::with_port("localhost"), "localhost:50051");
    EXPECT_EQ(address::with_port("192.0.2.7"), "192.0.2.7:50051");
    EXPECT_EQ(address::with_port("[::1]"), "[::1]:50051");
    for (const char* address : {"", "localhost:1", "[::1]:443", "unix:/run/meniscus", "unix:socket",
                                "dns:///example.org", "ipv4:127.0.0.1:1", "::1"})
        EXPECT_EQ(address::with_port(address), address);
}

TEST(DefaultPort, WhatIsNoPortIsRefused) {
    for (const char* address : {"localhost:65536", "localhost:116087", "localhost:0", "localhost:", "localhost:50051x",
                                "localhost: 50051", "[::1]:99999"}) {
        EXPECT_TRUE(address::has_bad_port(address)) << address;
        EXPECT_THROW(client::Client{address}, InvalidInput) << address;
    }
    for (const char* address :
         {"localhost", "localhost:1", "localhost:65535", "localhost:https", "[::1]", "[::1]:443", "unix:socket",
          "unix:/run/meniscus", "unix-abstract:socket", "dns:localhost", "dns:///localhost:1", "ipv4:127.0.0.1:1", ""})
        EXPECT_FALSE(address::has_bad_port(address)) << address;
}

TEST(DefaultPort, IsNotGuessedForIpv6WithoutBrackets) {
    for (const char* address : {"::1", "2001:db8::7", "::1:50051"}) {
        EXPECT_TRUE(address::is_bare_ipv6(address)) << address;
        EXPECT_THROW(client::Client{address}, InvalidInput) << address;
    }
    for (const char* address : {"[::1]", "localhost", "127.0.0.1", "unix:a"})
        EXPECT_FALSE(address::is_bare_ipv6(address)) << address;
}

TEST(Server, RefusesOtherMachinesWithoutTlsUnlessThatIsMeant) {
    ServerOptions options = test_options();
    options.listen = "0.0.0.0:0";
    EXPECT_THROW(Server{options}, InvalidInput);
    options.insecure = true;
    EXPECT_NO_THROW(Server{options});
    const TestCertificates certificates;
    options.insecure = false;
    options.tls = certificates.server_files();
    EXPECT_NO_THROW(Server{options});
}

TEST(Server, OffersNothingBesideItsTokensThatDoesNotAskForOne) {
    const TestFolder folder;
    for (bool ServerOptions::*const service : {&ServerOptions::reflection, &ServerOptions::channelz}) {
        ServerOptions options = test_options();
        options.*service = true;
        EXPECT_TRUE(problems_of(options).empty());
        options.tokens = folder.write("tokens", file_text);
        EXPECT_EQ(problems_of(options).size(), 1U);
        EXPECT_THROW(Server{options}, InvalidInput);
    }
}

TEST(Client, SendsNoTokenToAnotherMachineWithoutTlsUnlessThatIsMeant) {
    // An address for documentation: there is no such host.
    client::ConnectionOptions options{.token = ada, .timeout = std::chrono::milliseconds(1)};
    EXPECT_THROW(client::Client("192.0.2.1:1", options), InvalidInput);
    options.insecure = true;
    EXPECT_THROW(client::Client("192.0.2.1:1", options), client::ServerError);
}

TEST(Client, RefusesATokenThatCannotTravel) {
    for (const char* token : {"two words", "line\n", "\x01", "t\xc3\xbcr"})
        EXPECT_THROW(client::Client("127.0.0.1:1", {.token = token}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
