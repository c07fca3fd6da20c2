// GET /sessions/ID/latest.glb: the newest mesh for everything that reads glTF, to callers that may see it.
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "attribute_frames.hpp"
#include "meniscus/error.hpp"
#include "test_certificates.hpp"
#include "test_folder.hpp"
#include "web/file_request.hpp"
#include "web/http_server.hpp"
#include "web/mesh_glb.hpp"

namespace meniscus::server::test {
namespace {

using nlohmann::json;

void play(client::Client& client, const std::string& id, const ParticleFrame& frame, std::uint64_t index) {
    auto stream = client.stream(id, {.receive_meshes = false});
    stream.push(frame, index, 0.0);
    stream.finish();
    while (stream.next()) {
    }
}

std::string target_of(const std::string& id, const std::string& query = "") {
    return "/sessions/" + id + "/latest.glb" + query;
}

struct Glb {
    explicit Glb(const std::string& file) {
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(word(file, 4), 2U);
        EXPECT_EQ(word(file, 8), file.size());
        const std::size_t length = word(file, 12);
        document = json::parse(file.substr(20, length));
        if (20 + length < file.size()) buffer = file.substr(28 + length, word(file, 20 + length));
    }

    static std::uint32_t word(const std::string& file, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, file.data() + at, sizeof value);
        return value;
    }

    /// All values of a plain primitive's accessor; their vertices follow one another without gaps.
    template <class T>
    std::vector<T> values(std::size_t accessor) const {
        const json& described = document["accessors"][accessor];
        const json& view = document["bufferViews"][described["bufferView"].get<std::size_t>()];
        std::vector<T> out(view["byteLength"].get<std::size_t>() / sizeof(T));
        std::memcpy(out.data(), buffer.data() + view["byteOffset"].get<std::size_t>(), out.size() * sizeof(T));
        return out;
    }
    const json& primitive() const { return document["meshes"][0]["primitives"][0]; }
    template <class T>
    std::vector<T> attribute(const std::string& name) const {
        return values<T>(primitive()["attributes"][name].get<std::size_t>());
    }
    /// The places of the vertices, in the lattice of the tests' settings; the root is not turned.
    std::vector<LatticePosition> places(const Mesh& lattice) const {
        const auto positions = attribute<float>("POSITION");
        const double unit = lattice.cell_size / static_cast<double>(1U << lattice.offset_bits);
        std::vector<LatticePosition> places(positions.size() / 3);
        for (std::size_t i = 0; i < positions.size(); ++i)
            places[i / 3][i % 3] = static_cast<std::int32_t>(
                std::lround((positions[i] + document["nodes"][0]["translation"][i % 3].get<double>()) / unit));
        return places;
    }

    json document;
    std::string buffer;
};

/// Triangles by their corners, in no order but their own.
using Corners = std::multiset<std::array<LatticePosition, 3>>;

template <class Places, class Triangles>
Corners corners_of(const Places& places, const Triangles& triangles) {
    Corners all;
    for (const Triangle& triangle : triangles) {
        std::array<LatticePosition, 3> corners{places[triangle[0]], places[triangle[1]], places[triangle[2]]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.insert(corners);
    }
    return all;
}

class LatestMeshOnAServer : public testing::Test {
protected:
    HttpAnswer get(const std::string& query = "", const Headers& headers = {}) const {
        return ask(http, target_of(id, query), headers);
    }

    RunningServer running{web_options()};
    const std::string id = running.session();
    const std::string http = running.server.http_address();
};

TEST_F(LatestMeshOnAServer, IsTheMeshThatIsMadeInThisProcess) {
    play(running.client, id, wave(8, 0.0).view(), 3);
    const ParticlesWithArrays newest(wave(8, 1.0));
    play(running.client, id, newest.particles.view(), 4);
    const Mesh expected = made_here(newest.particles.view(), settings(), {});
    const HttpAnswer answer = get();
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(value_of(answer, "Content-Type"), "model/gltf-binary");
    EXPECT_EQ(value_of(answer, "Cache-Control"), "no-cache");
    const Glb glb(answer.body);
    EXPECT_FALSE(glb.document.contains("extensionsUsed"));
    EXPECT_FALSE(glb.document["nodes"][0].contains("rotation"));
    const auto indices = glb.values<std::uint32_t>(glb.primitive()["indices"].get<std::size_t>());
    std::vector<Triangle> triangles(indices.size() / 3);
    std::memcpy(triangles.data(), indices.data(), indices.size() * sizeof indices[0]);
    EXPECT_EQ(corners_of(glb.places(expected), triangles), corners_of(expected.vertices, expected.triangles));
    EXPECT_EQ(glb.attribute<float>("NORMAL").size(), 3 * expected.vertices.size());
}

TEST_F(LatestMeshOnAServer, HasTheAttributesThatAreAskedForExactly) {
    const std::string with = client::new_session_id();
    running.client.create_session(with, settings_with({"velocity", "id"}));
    const ParticlesWithArrays particles(wave(8, 0.3));
    play(running.client, with, particles.view(), 0);
    const Mesh expected = made_here(particles.view(), settings_with({"velocity", "id"}), all_exact);
    const Glb glb(ask(http, target_of(with, "?attribute=velocity")).body);
    EXPECT_FALSE(glb.primitive()["attributes"].contains("_ID"));
    const auto velocity = glb.attribute<float>("_VELOCITY");
    ASSERT_EQ(velocity.size(), 3 * expected.vertices.size());
    std::map<LatticePosition, std::array<float, 3>> at;
    for (std::size_t v = 0; v < expected.vertices.size(); ++v)
        std::memcpy(at[expected.vertices[v]].data(), expected.attributes[0].data.data() + 12 * v, 12);
    const auto places = glb.places(expected);
    for (std::size_t v = 0; v < places.size(); ++v)
        ASSERT_EQ((std::array{velocity[3 * v], velocity[3 * v + 1], velocity[3 * v + 2]}), at[places[v]]) << v;
    const Glb all(ask(http, target_of(with, "?attribute=all")).body);
    EXPECT_TRUE(all.primitive()["attributes"].contains("_VELOCITY"));
    EXPECT_TRUE(all.primitive()["attributes"].contains("_ID"));
    EXPECT_FALSE(Glb(ask(http, target_of(with)).body).primitive()["attributes"].contains("_VELOCITY"));
}

TEST_F(LatestMeshOnAServer, HasTheBytesOfTheBricksWhereTheyAreAskedFor) {
    play(running.client, id, wave(8, 0.0).view(), 0);
    const Glb glb(get("?draco").body);
    EXPECT_EQ(glb.document["extensionsRequired"], json({"KHR_draco_mesh_compression", "KHR_mesh_quantization"}));
    std::multiset<std::string> bytes;
    std::uint64_t triangles = 0;
    for (std::size_t i = 0; i < glb.document["meshes"].size(); ++i) {
        const json& primitive = glb.document["meshes"][i]["primitives"][0];
        const json& view =
            glb.document["bufferViews"]
                        [primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"].get<std::size_t>()];
        bytes.insert(glb.buffer.substr(view["byteOffset"].get<std::size_t>(), view["byteLength"].get<std::size_t>()));
        triangles +=
            glb.document["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::uint64_t>() / 3;
    }
    const auto snapshot = running.client.snapshot(id, {.codec = Codec::draco});
    ASSERT_TRUE(snapshot);
    std::multiset<std::string> expected;
    for (const auto& brick : snapshot->bricks)
        if (brick->triangles > 0)
            expected.emplace(reinterpret_cast<const char*>(brick->data.data()), brick->data.size());
    EXPECT_GT(expected.size(), 0U);
    EXPECT_EQ(bytes, expected);
    EXPECT_EQ(triangles, snapshot->mesh().triangles.size());
}

TEST_F(LatestMeshOnAServer, StandsUprightByTheSessionsUpAxis) {
    const std::string upright = client::new_session_id();
    running.client.create_session(upright, settings(), {.description = {.up_axis = client::UpAxis::z}});
    play(running.client, upright, wave(6, 0.0).view(), 0);
    play(running.client, id, wave(6, 0.0).view(), 0);
    const json lying = Glb(get().body).document["nodes"][0]["translation"];
    for (const char* query : {"", "?draco"}) {
        const json node = Glb(ask(http, target_of(upright, query)).body).document["nodes"][0];
        EXPECT_NEAR(node["rotation"][0].get<double>(), -std::sqrt(0.5), 1e-15);
        EXPECT_NEAR(node["rotation"][3].get<double>(), std::sqrt(0.5), 1e-15);
    }
    const json turned = Glb(ask(http, target_of(upright)).body).document["nodes"][0]["translation"];
    EXPECT_EQ(turned[0], lying[0]);
    EXPECT_EQ(turned[1], lying[2]);
    EXPECT_EQ(turned[2].get<double>(), -lying[1].get<double>());
}

TEST_F(LatestMeshOnAServer, IsSentAgainOnlyWhenItIsAnother) {
    play(running.client, id, wave(6, 0.0).view(), 0);
    const HttpAnswer first = get();
    const std::string tag = value_of(first, "ETag");
    ASSERT_TRUE(tag.starts_with('"')) << first.header;
    for (const std::string& known : {tag, "\"other\", W/" + tag, std::string("*")}) {
        const HttpAnswer unchanged = get("", {{"If-None-Match", known}});
        EXPECT_EQ(unchanged.status, 304) << known;
        EXPECT_EQ(value_of(unchanged, "ETag"), tag);
        EXPECT_EQ(unchanged.body, "");
        for (const char* name : {"Content-Length", "Content-Type", "Transfer-Encoding"})
            EXPECT_EQ(value_of(unchanged, name), "") << name << ", which the file has";
    }
    EXPECT_EQ(get().body, first.body);
    EXPECT_EQ(get("?draco", {{"If-None-Match", tag}}).status, 200);
    EXPECT_EQ(get("?attribute=all", {{"If-None-Match", tag}}).status, 200);
    play(running.client, id, wave(6, 1.0).view(), 0);
    const HttpAnswer other = get("", {{"If-None-Match", tag}});
    EXPECT_EQ(other.status, 200) << "the same index of another run";
    EXPECT_NE(value_of(other, "ETag"), tag);
}

/// A frame 0 of run 7, as a client that names its runs by itself may send it.
void play_run(const std::string& address, const std::string& id, std::uint64_t run, const Particles& particles) {
    RawStream stream(address, id, false);
    v1::StreamRequest request;
    request.mutable_open()->set_session_id(id);
    request.mutable_open()->set_run_id(run);
    stream.call->Write(request);
    stream.send_begin(0, particles.positions.size() / 3);
    const auto* const bytes = reinterpret_cast<const char*>(particles.positions.data());
    stream.send_data(std::string(bytes, particles.positions.size() * sizeof(float)));
    stream.send_end();
    stream.call->WritesDone();
    const grpc::Status status = stream.finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(LatestMeshOnAServer, IsAnotherInASessionThatTookTheIdOfOneWithTheSameRunAndFrame) {
    play_run(running.server.address(), id, 7, wave(6, 0.0));
    const std::string tag = value_of(get(), "ETag");
    EXPECT_EQ(get("", {{"If-None-Match", tag}}).status, 304);
    running.client.delete_session(id);
    running.client.create_session(id, settings());
    play_run(running.server.address(), id, 7, wave(6, 1.0));
    const HttpAnswer other = get("", {{"If-None-Match", tag}});
    EXPECT_EQ(other.status, 200);
    EXPECT_NE(value_of(other, "ETag"), tag);
    const std::string later = value_of(other, "ETag");
    play_run(running.server.address(), id, 8, wave(6, 0.5));
    play_run(running.server.address(), id, 7, wave(6, 0.0));
    EXPECT_EQ(get("", {{"If-None-Match", later}}).status, 200) << "a run of that number has begun anew";
}

TEST_F(LatestMeshOnAServer, IsNoneBeforeTheFirstFrameAndAFileWithoutASurfaceIsOne) {
    const HttpAnswer none = get();
    EXPECT_EQ(none.status, 404);
    EXPECT_NE(none.body.find("no mesh yet"), std::string::npos) << none.body;
    play(running.client, id, Particles().view(), 0);
    for (const char* query : {"", "?draco"}) {
        const HttpAnswer empty = get(query);
        ASSERT_EQ(empty.status, 200) << empty.body;
        EXPECT_FALSE(Glb(empty.body).document.contains("meshes"));
    }
}

TEST_F(LatestMeshOnAServer, IsDescribedByHeadAndFollowsOnOneConnection) {
    play(running.client, id, wave(6, 0.0).view(), 0);
    const HttpAnswer whole = get();
    const HttpAnswer head = ask(http, target_of(id), {}, "HEAD");
    EXPECT_EQ(head.status, 200);
    for (const char* name : {"ETag", "Content-Length", "Content-Type"})
        EXPECT_EQ(value_of(head, name), value_of(whole, name)) << name;
    HttpClient client(http);
    for (const int round : {0, 1, 2}) {
        client.send("GET " + target_of(id) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(client.receive().body, whole.body) << round;
    }
}

TEST_F(LatestMeshOnAServer, IsRefusedInWords) {
    const std::string unknown = client::new_session_id();
    expect_refused(http,
                   {
                       {target_of(unknown), "GET", {}, 404, unknown},
                       {target_of("no-id"), "GET", {}, 404, "hexadecimal"},
                       {"/sessions//latest.glb", "GET", {}, 404, ""},
                       {target_of(id, "?token=secret"), "GET", {}, 400, "token=secret"},
                       {target_of(id, "?draco&attribute=velocity"), "GET", {}, 400, "exclude"},
                       {target_of(id, "?attribute="), "GET", {}, 400, "attribute="},
                       {target_of(id, "?attribute=\xff"), "GET", {}, 400, ""},
                       {target_of(id, "?attribute=Speed"), "GET", {}, 400, "a-z"},
                       {target_of(id, "?attribute=age&attribute=age"), "GET", {}, 400, "twice"},
                       {target_of(id), "POST", {{"Content-Length", "0"}}, 405, "GET and HEAD"},
                       {target_of(id), "GET", {{"Content-Length", "3"}}, 413, "body"},
                       {target_of(id), "GET", {{"Origin", "https://elsewhere.example"}}, 403, "elsewhere.example"},
                       {target_of(id), "GET", {{"Host", "elsewhere.example"}}, 421, "elsewhere.example"},
                       {target_of(id), "GET", {{"Authorization", "Bearer t\x01"}}, 400, ""},
                   });
    EXPECT_EQ(http_get(http, "/healthz").status, 200);
}

TEST(LatestMesh, IsReadByPagesOfListedOriginsAlone) {
    ServerOptions options = web_options();
    options.web_origins = {"https://listed.example"};
    RunningServer running(options);
    const std::string id = running.session();
    play(running.client, id, wave(4, 0.0).view(), 0);
    const std::string http = running.server.http_address();
    const Headers from_page{{"Origin", "https://listed.example"}};
    const HttpAnswer answer = ask(http, target_of(id), from_page);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(value_of(answer, "Access-Control-Allow-Origin"), "https://listed.example");
    EXPECT_NE(value_of(answer, "Access-Control-Expose-Headers").find("etag"), std::string::npos) << answer.header;
    EXPECT_EQ(value_of(ask(http, target_of(client::new_session_id()), from_page), "Access-Control-Allow-Origin"),
              "https://listed.example");
    const HttpAnswer before = ask(http, target_of(id), from_page, "OPTIONS");
    EXPECT_EQ(before.status, 204);
    EXPECT_EQ(value_of(before, "Access-Control-Allow-Methods"), "GET, HEAD");
    EXPECT_NE(value_of(before, "Access-Control-Allow-Headers").find("if-none-match"), std::string::npos);
    EXPECT_EQ(ask(http, target_of(id), {{"Origin", "https://listed.example.evil"}}).status, 403);
}

TEST(LatestMesh, IsForThoseWhoseTokenMaySeeTheSession) {
    const TestFolder folder;
    ServerOptions options = web_options();
    options.tokens = folder.write("tokens",
                                  "uploader ada token-of-ada-0123456789\nuploader ben token-of-ben-0123456789\n"
                                  "watcher eve token-of-eve-0123456789\n");
    const Server server(options);
    client::Client ada(server.address(), {.token = "token-of-ada-0123456789"});
    const std::string id = client::new_session_id();
    ada.create_session(id, settings());
    play(ada, id, wave(4, 0.0).view(), 0);
    const auto status_with = [&](const std::string& token) {
        return ask(server.http_address(), target_of(id), {{"Authorization", "Bearer " + token}}).status;
    };
    EXPECT_EQ(status_with("token-of-ada-0123456789"), 200);
    EXPECT_EQ(status_with("token-of-eve-0123456789"), 200);
    EXPECT_EQ(status_with("token-of-ben-0123456789"), 404) << "not his session";
    EXPECT_EQ(status_with("token-of-nobody-0123456"), 401);
    const HttpAnswer without = ask(server.http_address(), target_of(id));
    EXPECT_EQ(without.status, 401);
    EXPECT_EQ(value_of(without, "WWW-Authenticate"), "Bearer");
    EXPECT_EQ(without.body.find("no mesh"), std::string::npos);
}

TEST(LatestMesh, IsRefusedPastTheLimitOfSnapshotsAndOfStreams) {
    ServerOptions options = web_options();
    options.limits.snapshots = 1;
    RunningServer running(options);
    const std::string id = running.session();
    play(running.client, id, spray(20).view(), 0);  // more than gRPC's buffers hold
    const client::Connection connection(running.server.address());
    grpc::ClientContext context;
    client::add_session_id(context, id);
    v1::SnapshotRequest request;
    request.set_session_id(id);
    const auto stalled = connection.surfaces->Snapshot(&context, request);
    stalled->WaitForInitialMetadata();
    const HttpAnswer full = ask(running.server.http_address(), target_of(id));
    EXPECT_EQ(full.status, 429);
    EXPECT_NE(full.body.find("at most 1"), std::string::npos) << full.body;
    context.TryCancel();
    v1::WatchResponse ignored;
    while (stalled->Read(&ignored)) {
    }
    stalled->Finish();

    const HttpServer http(
        "127.0.0.1:0", Router(),
        {.channel = grpc::CreateChannel(running.server.address(), grpc::InsecureChannelCredentials()), .origins = {}},
        {.streams = 0});
    const HttpAnswer crowded = ask(http.address(), target_of(id));
    EXPECT_EQ(crowded.status, 429);
    EXPECT_NE(crowded.body.find("0 streams"), std::string::npos) << crowded.body;
}

TEST(LatestMesh, ThatNobodyTakesDoesNotHoldTheServerUp) {
    ServerOptions options = web_options();
    options.shutdown_grace = std::chrono::seconds(1);
    RunningServer running(options);
    const std::string id = running.session();
    play(running.client, id, spray(20).view(), 0);
    std::vector<std::unique_ptr<HttpClient>> clients;
    for (int i = 0; i < 8; ++i) {
        clients.push_back(std::make_unique<HttpClient>(running.server.http_address()));
        clients.back()->send("GET " + target_of(id) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    clients.resize(4);  // the others have left
    const auto start = std::chrono::steady_clock::now();
    running.server.shutdown();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(LatestMesh, OfMoreThanTheFormatHoldsIsRefusedBeforeAnythingIsSent) {
    v1::MeshBegin mesh;
    mesh.set_triangle_count(150'000'000);
    EXPECT_NO_THROW(require_possible_glb({}, mesh));
    v1::MeshAttribute& velocity = *mesh.add_attributes();
    velocity.set_components(3);
    velocity.set_bits(0);
    EXPECT_THROW(require_possible_glb({}, mesh), LimitExceeded) << "3.6 GB without it, 4.5 GB with it";
    MeshRequest draco;
    draco.draco = true;
    EXPECT_NO_THROW(require_possible_glb(draco, mesh)) << "its size is not known yet";
}

}  // namespace
}  // namespace meniscus::server::test
