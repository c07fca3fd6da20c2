// GET /publications/...: what readers, caches and strangers are answered, and that frames come as they were made.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"
#include "meniscus/sha256.hpp"
#include "test_certificates.hpp"
#include "test_folder.hpp"
#include "web/file_request.hpp"

namespace meniscus::server::test {
namespace {

ServerOptions publishing_options() {
    ServerOptions options = web_options();
    options.publishing.enabled = true;
    return options;
}

std::string target_of(const std::string& id, const std::string& file = "manifest.json") {
    return "/publications/" + id + "/" + file;
}

/// Publishes a new session. frames: streamed to it, one after the other.
std::string published(client::Client& client, const std::vector<Particles>& frames,
                      const client::SessionDescription& description = {}) {
    std::string id = client::new_session_id();
    client.create_session(id, settings(), {.description = description, .publish = true});
    auto stream = client.stream(id, {.receive_meshes = false});
    for (std::size_t i = 0; i < frames.size(); ++i) stream.push(frames[i].view(), 3 * i, 0.5 * static_cast<double>(i));
    stream.finish();
    while (stream.next()) {
    }
    return id;
}

/// The C++ reader, over HTTP.
client::Publication reader(const std::string& http, const std::string& id, const Headers& headers = {}) {
    return {id, [=](const std::string& name, std::uint64_t most) {
                const HttpAnswer answer = ask(http, target_of(id, name), headers);
                if (answer.status != 200) throw InvalidInput(name + ": " + answer.body);
                if (answer.body.size() > most) throw InvalidInput(name + " is too large");
                return answer.body;
            }};
}

/// Once it has this number of frames.
client::Publication reader_of(std::uint64_t frames, const std::string& http, const std::string& id,
                              const Headers& headers = {}) {
    auto publication = reader(http, id, headers);
    while (publication.info().left_frames + publication.info().frames < frames) {
        std::this_thread::yield();
        publication.refresh();
    }
    return publication;
}

std::vector<Particles> waves(int count) {
    std::vector<Particles> frames;
    frames.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) frames.push_back(wave(8, 0.3 * i));
    return frames;
}

class PublishedFilesOnAServer : public testing::Test {
protected:
    HttpAnswer get(const std::string& file, const Headers& headers = {}, const std::string& method = "GET") const {
        return ask(http, target_of(id, file), headers, method);
    }

    RunningServer running{publishing_options()};
    const std::string http = running.server.http_address();
    const std::vector<Particles> frames = waves(20);
    const std::string id =
        published(running.client, frames, {.name = "tank", .up_axis = client::UpAxis::z, .length_unit = "m"});
    client::Publication publication = reader_of(frames.size(), http, id);
    const std::string segment = publication.info().segments.front().file();
};

TEST_F(PublishedFilesOnAServer, AreTheFramesThatAreMadeInThisProcessWholeAndAfterSeeks) {
    std::vector<std::string> expected;
    for (const Particles& frame : frames) expected.push_back(local_sha256(frame));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const client::ReceivedFrame frame = publication.frame(i);
        EXPECT_EQ(frame.index, 3 * i);
        EXPECT_EQ(frame.simulation_time, 0.5 * static_cast<double>(i));
        EXPECT_EQ(mesh_sha256(frame.mesh()), expected[i]) << i;
    }
    std::mt19937 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same places each time
    for (int seek = 0; seek < 50; ++seek) {
        const std::size_t i = random() % frames.size();
        ASSERT_EQ(mesh_sha256(publication.frame(i).mesh()), expected[i]) << i;
    }
    const client::PublicationInfo& info = publication.info();
    EXPECT_EQ(info.description.name, "tank");
    EXPECT_EQ(info.description.up_axis, client::UpAxis::z);
    EXPECT_EQ(info.settings, in_force(settings()));
    EXPECT_TRUE(info.live) << "the session rests, and lives";
}

TEST_F(PublishedFilesOnAServer, AreAnsweredAlikeWholeInPartsByHeadAndUnchanged) {
    for (const std::string& file : {segment, std::string("manifest.json")}) {
        const HttpAnswer whole = get(file);
        ASSERT_EQ(whole.status, 200);
        const std::string tag = value_of(whole, "ETag");
        EXPECT_EQ(tag, '"' + sha256_of(whole.body) + '"') << "a strong one";
        EXPECT_EQ(value_of(whole, "Accept-Ranges"), "bytes");
        EXPECT_EQ(value_of(whole, "Content-Encoding"), "");
        EXPECT_EQ(value_of(whole, "Vary"), "Origin");
        const HttpAnswer head = get(file, {{"Range", "bytes=0-3"}}, "HEAD");
        EXPECT_EQ(head.status, 200);
        for (const char* name : {"ETag", "Content-Length", "Content-Type", "Cache-Control", "Accept-Ranges"})
            EXPECT_EQ(value_of(head, name), value_of(whole, name)) << name;
        const std::size_t size = whole.body.size();
        std::string parts;
        for (const auto& [first, last] :
             std::map<std::size_t, std::size_t>{{0, 0}, {1, size / 2}, {size / 2 + 1, size}}) {
            const HttpAnswer part =
                get(file, {{"Range", "bytes=" + std::to_string(first) + '-' + std::to_string(last)}});
            EXPECT_EQ(part.status, 206);
            EXPECT_EQ(value_of(part, "ETag"), tag);
            EXPECT_EQ(value_of(part, "Content-Range"), "bytes " + std::to_string(first) + '-' +
                                                           std::to_string(std::min(last, size - 1)) + '/' +
                                                           std::to_string(size));
            parts += part.body;
        }
        EXPECT_EQ(parts, whole.body);
        EXPECT_EQ(get(file, {{"Range", "bytes=-7"}}).body, whole.body.substr(size - 7));
        for (const std::string& known : {tag, "\"other\", W/" + tag, std::string("*")}) {
            const HttpAnswer unchanged = get(file, {{"If-None-Match", known}, {"Range", "bytes=0-3"}});
            EXPECT_EQ(unchanged.status, 304) << known;
            EXPECT_EQ(unchanged.body, "");
            EXPECT_EQ(value_of(unchanged, "Cache-Control"), value_of(whole, "Cache-Control"));
        }
        EXPECT_EQ(get(file, {{"If-None-Match", "\"other\""}}).body, whole.body);
        EXPECT_EQ(get(file, {{"Range", "bytes=0-3"}, {"If-Range", tag}}).status, 206);
        for (const char* other : {"\"other\"", "W/\"other\"", "Thu, 26 Nov 2026 15:00:00 GMT"})
            EXPECT_EQ(get(file, {{"Range", "bytes=0-3"}, {"If-Range", other}}).body, whole.body) << other;
        EXPECT_EQ(get(file, {{"Range", "bytes=0-3"}, {"If-Range", "W/" + tag}}).status, 200) << "a weak one";
        const HttpAnswer beyond = get(file, {{"Range", "bytes=99999999999999999999-"}});
        EXPECT_EQ(beyond.status, 416);
        EXPECT_EQ(value_of(beyond, "Content-Range"), "bytes */" + std::to_string(size));
    }
    EXPECT_EQ(value_of(get(segment), "Cache-Control"), "max-age=31536000, immutable");
    EXPECT_EQ(value_of(get("manifest.json"), "Cache-Control"), "max-age=1");
    EXPECT_EQ(value_of(get("manifest.json"), "Content-Type"), "application/json");
}

TEST_F(PublishedFilesOnAServer, FollowEachOtherOnOneConnection) {
    const std::string whole = get(segment).body;
    HttpClient client(http);
    for (const std::string& more : {std::string(), std::string("Range: bytes=3-5\r\n"), std::string()}) {
        client.send("GET " + target_of(id, segment) + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n");
        EXPECT_EQ(client.receive().body, more.empty() ? whole : whole.substr(3, 3));
    }
}

TEST_F(PublishedFilesOnAServer, AreRefusedInWords) {
    const std::string unknown = client::new_session_id();
    const std::string unpublished = running.session();
    const std::string other_hash(64, 'a');
    expect_refused(http,
                   {
                       {target_of(unknown), "GET", {}, 404, unknown},
                       {target_of(unpublished), "GET", {}, 404, "not published"},
                       {target_of("no-id"), "GET", {}, 404, "hexadecimal"},
                       {"/publications/", "GET", {}, 404, "manifest.json"},
                       {"/publications/" + id, "GET", {}, 404, "manifest.json"},
                       {target_of(id, ""), "GET", {}, 404, "manifest.json"},
                       {target_of(id, other_hash + ".segment"), "GET", {}, 404, "no such file"},
                       {target_of(id, segment + "/"), "GET", {}, 404, ""},
                       {target_of(id, "manifest.json?token=secret"), "GET", {}, 400, "no parameters"},
                       {target_of(id, "../" + id + "/manifest.json"), "GET", {}, 400, "dots"},
                       {target_of(id, "%2e%2e/manifest.json"), "GET", {}, 400, "escapes"},
                       {target_of(id, "..\\manifest.json"), "GET", {}, 400, ""},
                       {target_of(id, "\xff\xfe"), "GET", {}, 404, ""},
                       {target_of(id), "POST", {{"Content-Length", "0"}}, 405, "GET and HEAD"},
                       {target_of(id), "GET", {{"Content-Length", "3"}}, 413, "body"},
                       {target_of(id), "GET", {{"Origin", "https://elsewhere.example"}}, 403, "elsewhere.example"},
                       {target_of(id), "GET", {{"Host", "elsewhere.example"}}, 421, "elsewhere.example"},
                   });
}

TEST_F(PublishedFilesOnAServer, EndWithTheirSessionAndStay) {
    running.client.delete_session(id);
    do {
        std::this_thread::yield();
        publication.refresh();
    } while (publication.info().live);
    EXPECT_EQ(publication.info().frames, frames.size());
    EXPECT_EQ(mesh_sha256(publication.frame(7).mesh()), local_sha256(frames[7]));
}

TEST_F(PublishedFilesOnAServer, GoAtOnceWithASessionThatIsDeletedWithThem) {
    running.client.delete_session(id, {.unpublish = true});
    EXPECT_EQ(ask(http, target_of(id)).status, 404);
    EXPECT_EQ(ask(http, target_of(id, segment)).status, 404);
    EXPECT_THROW(running.client.delete_session(id, {.unpublish = true}), client::ServerError) << "nothing is left";
}

TEST_F(PublishedFilesOnAServer, GoAtOnceAlsoAfterTheirSession) {
    running.client.delete_session(id);
    EXPECT_EQ(ask(http, target_of(id)).status, 200);
    EXPECT_THROW(running.client.delete_session(id), client::ServerError) << "the session has gone";
    running.client.delete_session(id, {.unpublish = true});
    EXPECT_EQ(ask(http, target_of(id)).status, 404);
}

TEST_F(PublishedFilesOnAServer, GoOnInASessionThatIsCreatedAnew) {
    running.client.delete_session(id);
    running.client.create_session(id, settings(), {.publish = true});
    auto stream = running.client.stream(id, {.receive_meshes = false});
    stream.push(frames[0].view(), 0, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    publication = reader_of(frames.size() + 1, http, id);
    EXPECT_TRUE(publication.info().live);
    EXPECT_EQ(mesh_sha256(publication.frame(frames.size()).mesh()), local_sha256(frames[0]));
}

TEST_F(PublishedFilesOnAServer, AreCountedInTheMetrics) {
    const std::string metrics = http_get(http, "/metrics").body;
    EXPECT_NE(metrics.find("meniscus_publications 1\n"), std::string::npos) << metrics;
    EXPECT_NE(metrics.find("meniscus_published_frames_total 20\n"), std::string::npos);
    EXPECT_NE(metrics.find("meniscus_publication_left_out_total 0\n"), std::string::npos);
}

TEST(PublishedFiles, HaveABoundedWindow) {
    ServerOptions options = publishing_options();
    options.publishing.limit = 60'000;
    RunningServer running(options);
    const std::string id = published(running.client, waves(120));
    const std::string& http = running.server.http_address();
    const auto publication = reader_of(120, http, id);
    EXPECT_GT(publication.info().left_frames, 0U);
    EXPECT_LE(publication.info().bytes, 60'000U);
}

TEST(PublishedFiles, NeedAnHttpPort) {
    ServerOptions options = publishing_options();
    options.http.clear();
    EXPECT_THROW(RunningServer{options}, InvalidInput);
    const std::vector<std::string> problems = problems_of(options);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_NE(problems[0].find("--http"), std::string::npos) << problems[0];
}

TEST(PublishedFiles, AreReadByPagesOfListedOriginsAlone) {
    ServerOptions options = publishing_options();
    options.web_origins = {"https://paper.example"};
    RunningServer running(options);
    const std::string id = published(running.client, waves(1));
    const std::string& http = running.server.http_address();
    const auto from = [&](const std::string& origin, const std::string& method, const Headers& more = {}) {
        Headers headers = more;
        headers.emplace_back("Origin", origin);
        return ask(http, target_of(id), headers, method);
    };
    const HttpAnswer answer = from("https://paper.example", "GET");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(value_of(answer, "Access-Control-Allow-Origin"), "https://paper.example");
    EXPECT_NE(value_of(answer, "Access-Control-Expose-Headers").find("content-range"), std::string::npos);
    EXPECT_EQ(from("https://elsewhere.example", "GET").status, 403);
    const HttpAnswer question = from("https://paper.example", "OPTIONS", {{"Access-Control-Request-Method", "GET"}});
    EXPECT_EQ(question.status, 204);
    EXPECT_EQ(value_of(question, "Access-Control-Allow-Methods"), "GET, HEAD");
    for (const char* header : {"range", "if-range", "if-none-match", "authorization"})
        EXPECT_NE(value_of(question, "Access-Control-Allow-Headers").find(header), std::string::npos) << header;
}

TEST(PublishedFiles, AreForThoseWhoseTokenMaySeeTheSession) {
    const TestFolder folder;
    ServerOptions options = publishing_options();
    options.tokens = folder.write("tokens",
                                  "uploader ada token-of-ada-0123456789\nuploader ben token-of-ben-0123456789\n"
                                  "watcher eve token-of-eve-0123456789\n");
    RunningServer running(options);
    client::Client ada(running.server.address(), {.token = "token-of-ada-0123456789"});
    const std::string id = published(ada, waves(3));
    const std::string& http = running.server.http_address();
    const auto with = [&](const std::string& token, const std::string& file = "manifest.json") {
        return ask(http, target_of(id, file), {{"Authorization", "Bearer " + token}});
    };
    const auto of_ada = reader_of(3, http, id, {{"Authorization", "Bearer token-of-ada-0123456789"}});
    for (const std::string& file : {std::string("manifest.json"), of_ada.info().segments.front().file()}) {
        const HttpAnswer answer = with("token-of-eve-0123456789", file);
        EXPECT_EQ(answer.status, 200);
        EXPECT_EQ(value_of(answer, "Vary"), "Origin, Authorization");
        EXPECT_TRUE(value_of(answer, "Cache-Control").starts_with("private, ")) << "no cache for all may have it";
        EXPECT_EQ(with("token-of-ben-0123456789", file).status, 404) << "not his session";
        EXPECT_EQ(with("token-of-nobody-0123456", file).status, 401);
        const HttpAnswer nobody = ask(http, target_of(id, file));
        EXPECT_EQ(nobody.status, 401);
        EXPECT_EQ(value_of(nobody, "WWW-Authenticate"), "Bearer");
        EXPECT_EQ(ask(http, target_of(id, file), {{"If-None-Match", value_of(answer, "ETag")}}).status, 401)
            << "a tag is no token";
    }
    ada.delete_session(id);
    EXPECT_EQ(with("token-of-ben-0123456789").status, 404) << "nor when it has ended";
    EXPECT_EQ(with("token-of-eve-0123456789").status, 200);
    for (const char* const other : {"token-of-ben-0123456789", "token-of-eve-0123456789"}) {
        client::Client caller(running.server.address(), {.token = other});
        EXPECT_THROW(caller.delete_session(id, {.unpublish = true}), client::ServerError) << "nor theirs to take away";
    }
    EXPECT_EQ(with("token-of-eve-0123456789").status, 200);
    ada.delete_session(id, {.unpublish = true});
    EXPECT_EQ(with("token-of-eve-0123456789").status, 404);
}

/// The refusal's code and words; none if it was taken.
std::optional<client::ServerError> refusal(client::Client& client, const std::string& id) {
    try {
        client.create_session(id, settings(), {.publish = true});
        return std::nullopt;
    } catch (const client::ServerError& error) {
        return error;
    }
}

TEST(PublishedFiles, AreRefusedByAServerThatPublishesNothing) {
    RunningServer running(web_options());
    EXPECT_FALSE(running.client.server_info().publishes);
    const std::string id = client::new_session_id();
    const auto error = refusal(running.client, id);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), client::ErrorCode::failed_precondition);
    EXPECT_NE(std::string(error->what()).find("--publish"), std::string::npos) << error->what();
    EXPECT_TRUE(running.client.sessions().empty());
    const HttpAnswer answer = ask(running.server.http_address(), target_of(id));
    EXPECT_EQ(answer.status, 404);
    EXPECT_NE(answer.body.find("--publish"), std::string::npos);
}

TEST(PublishedFiles, AreOfSessionsWhoseCreatorAskedForThem) {
    RunningServer running(publishing_options());
    EXPECT_TRUE(running.client.server_info().publishes);
    const std::string id = running.session();
    EXPECT_FALSE(running.client.session(id).published);
    const auto error = refusal(running.client, id);
    ASSERT_TRUE(error) << "who asks for it must not believe that it is published";
    EXPECT_EQ(error->code(), client::ErrorCode::failed_precondition);
    const std::string other = published(running.client, {});
    EXPECT_TRUE(running.client.session(other).published);
    EXPECT_FALSE(refusal(running.client, other));
    running.client.create_session(other, settings());
}

}  // namespace
}  // namespace meniscus::server::test
