// Which codec each receiver is sent, and that it makes no other mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conversion/codec_conversion.hpp"
#include "meniscus/codec.hpp"
#include "receiving/frame_receiver.hpp"
#include "recording/recording_service.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using Numbers = std::set<int>;
constexpr int draco = 1, packed = 2, entropy = 3;

/// The codecs of a call's bricks, and what it began with.
struct Answer {
    Numbers codecs;
    std::string chosen{};
    std::string reason{};
};

template <class Reader, class Response>
Numbers codecs_of(Reader& reader, Response response) {
    Numbers codecs;
    while (reader.Read(&response)) {
        if (response.has_mesh_brick()) codecs.insert(response.mesh_brick().codec());
        if (response.has_frame_statistics()) break;
    }
    return codecs;
}

std::string metadata(const grpc::ClientContext& context, const char* key) {
    const auto found = context.GetServerInitialMetadata().find(key);
    return found == context.GetServerInitialMetadata().end() ? std::string()
                                                             : std::string(found->second.data(), found->second.size());
}

/// Of the first frame.
template <class Call>
Answer answer(grpc::ClientContext& context, const Call& call) {
    Answer answer{.codecs = codecs_of(*call, v1::WatchResponse())};
    answer.chosen = metadata(context, "x-codec");
    answer.reason = metadata(context, "x-codec-reason");
    context.TryCancel();
    call->Finish();
    return answer;
}

Answer watch(const client::Connection& connection, const v1::WatchRequest& request) {
    grpc::ClientContext context;
    client::add_session_id(context, request.session_id());
    return answer(context, connection.surfaces->Watch(&context, request));
}

Answer snapshot(const client::Connection& connection, const v1::SnapshotRequest& request) {
    grpc::ClientContext context;
    client::add_session_id(context, request.session_id());
    return answer(context, connection.surfaces->Snapshot(&context, request));
}

Answer read(const client::Connection& connection, const v1::ReadRecordingRequest& request) {
    grpc::ClientContext context;
    client::add_session_id(context, request.session_id());
    return answer(context, connection.recordings->ReadRecording(&context, request));
}

/// A stream of one frame.
Answer answer_to_stream(const std::string& address, const std::string& id, const v1::StreamRequest& open) {
    RawStream stream(address, id, false);
    stream.call->Write(open);
    const Particles particles = wave(6, 0.0);
    stream.send_begin(1, particles.positions.size() / 3);
    stream.send_data({reinterpret_cast<const char*>(particles.positions.data()), particles.positions.size() * 4});
    stream.send_end();
    Answer answer{.codecs = codecs_of(*stream.call, v1::StreamResponse())};
    answer.chosen = metadata(stream.context, "x-codec");
    stream.call->WritesDone();
    EXPECT_TRUE(stream.finish().ok());
    return answer;
}

v1::WatchRequest watch_request(const std::string& id, const std::vector<int>& named,
                               std::uint64_t bytes_per_second = 0) {
    v1::WatchRequest request;
    request.set_session_id(id);
    request.set_bytes_per_second(bytes_per_second);
    for (const int codec : named) request.add_codecs(static_cast<v1::Codec>(codec));
    return request;
}

/// Has answered one frame.
void play(RunningServer& running, const std::string& id, const Particles& particles) {
    auto stream = running.client.stream(id);
    stream.push(particles.view(), 1, 0.0);
    stream.finish();
    while (stream.next()) {
    }
}

struct RequestsOfOlderClients {
    RequestsOfOlderClients() {
        std::ifstream file(MENISCUS_REQUESTS_OF_OLDER_CLIENTS);
        for (std::string call, codecs, hex; file >> call >> codecs >> hex;) {
            std::string bytes;
            for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
                bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
            requests[call].push_back(bytes);
        }
    }

    template <class Request>
    std::vector<Request> of(const std::string& call) const {
        std::vector<Request> parsed;
        for (const std::string& bytes : requests.at(call)) EXPECT_TRUE(parsed.emplace_back().ParseFromString(bytes));
        return parsed;
    }

    std::map<std::string, std::vector<std::string>> requests;
    const std::string id = "00000000-0000-4000-8000-0000000000ab";  ///< of their session
};

class Codecs : public RecordingService {};

TEST_F(Codecs, OfOlderClientsAreDracoWhateverTheyCall) {
    RunningServer running(options());
    const client::Connection connection(running.server.address());
    const RequestsOfOlderClients before;
    running.client.create_session(before.id, settings());
    for (const auto& request : before.of<v1::StreamRequest>("stream"))
        EXPECT_EQ(answer_to_stream(running.server.address(), before.id, request).codecs, Numbers{draco});
    for (const auto& request : before.of<v1::WatchRequest>("watch"))
        EXPECT_EQ(watch(connection, request).codecs, Numbers{draco});
    for (const auto& request : before.of<v1::SnapshotRequest>("snapshot"))
        EXPECT_EQ(snapshot(connection, request).codecs, Numbers{draco});
    recording(running.client, before.id, 1);
    EXPECT_EQ(
        formats::Recording(file(before.id)).mesh(formats::Recording(file(before.id)).frames()[0]).bricks[0]->codec,
        Codec::lattice_entropy);
    for (const auto& request : before.of<v1::ReadRecordingRequest>("recording"))
        EXPECT_EQ(read(connection, request).codecs, Numbers{draco});
}

TEST(CodecChoice, IsTheFirstThatTheClientNames) {
    RunningServer running;
    const client::Connection connection(running.server.address());
    const std::string id = running.session();
    play(running, id, wave(6, 0.0));
    for (const std::vector<int>& named : {std::vector{packed, entropy, draco}, {entropy, packed}, {draco, packed}}) {
        const Answer answer = watch(connection, watch_request(id, named));
        EXPECT_EQ(answer.codecs, Numbers{named[0]});
        EXPECT_EQ(answer.chosen, v1::Codec_Name(named[0]));
        EXPECT_EQ(answer.reason, "the first that the client names");
    }
    EXPECT_EQ(watch(connection, watch_request(id, {})).reason, "the client names none");
}

TEST(CodecChoice, IsTheSmallestThatIsNamedWhereBytesAreLimited) {
    RunningServer running;
    const client::Connection connection(running.server.address());
    const std::string id = running.session();
    play(running, id, wave(6, 0.0));
    const auto limited = [&](const std::vector<int>& named) {
        return watch(connection, watch_request(id, named, 1'000'000'000)).codecs;
    };
    EXPECT_EQ(limited({packed, entropy, draco}), Numbers{entropy});
    EXPECT_EQ(limited({draco, entropy}), Numbers{entropy});
    EXPECT_EQ(limited({packed, draco}), Numbers{packed});
    EXPECT_EQ(limited({}), Numbers{draco});
}

TEST(CodecChoice, ChangesNoMesh) {
    RunningServer running;
    const std::string id = running.session();
    const Particles particles = wave(24, 3.0);
    play(running, id, particles);
    for (const Codec codec : codecs)
        for (const int bits : {6, 3}) {
            const auto frame = running.client.snapshot(id, {.position_bits = bits, .codec = codec});
            ASSERT_TRUE(frame);
            ASSERT_FALSE(frame->bricks.empty());
            for (const auto& brick : frame->bricks) EXPECT_EQ(brick->codec, codec);
            const auto as_draco = running.client.snapshot(id, {.position_bits = bits, .codec = Codec::draco});
            EXPECT_EQ(mesh_sha256(frame->mesh()), mesh_sha256(as_draco->mesh())) << name_of(codec) << " " << bits;
            if (bits == 6) {
                EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles)) << name_of(codec);
            }
        }
}

TEST(CodecChoice, OfTheLibraryIsPackedWithinAMachineAndEntropyWhereBytesAreLimited) {
    RunningServer running;  // on a Unix socket
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    stream.push(wave(6, 0.0).view(), 1, 0.0);
    EXPECT_EQ(stream.next()->bricks.at(0)->codec, Codec::lattice_packed);
    EXPECT_EQ(running.client.watch(id).next()->bricks.at(0)->codec, Codec::lattice_packed);
    EXPECT_EQ(running.client.snapshot(id)->bricks.at(0)->codec, Codec::lattice_packed);
    EXPECT_EQ(running.client.watch(id, {.bytes_per_second = 1'000'000'000}).next()->bricks.at(0)->codec,
              Codec::lattice_entropy);
    EXPECT_EQ(running.client.watch(id, {.codec = Codec::draco}).next()->bricks.at(0)->codec, Codec::draco);
}

TEST_F(Codecs, OfRecordingsAreKeptAndDracoForReadersThatDoNotNameThem) {
    for (const auto& [codec, number] :
         {std::pair{Codec::lattice_entropy, entropy}, {Codec::lattice_packed, packed}, {Codec::draco, draco}}) {
        ServerOptions recording_options = options();
        recording_options.recording.codec = codec;
        RunningServer running(recording_options);
        const client::Connection connection(running.server.address());
        const std::string id = recorded(running, frames_);
        v1::ReadRecordingRequest request = request_for(id);
        EXPECT_EQ(read(connection, request).codecs, Numbers{draco});
        request.add_codecs(v1::CODEC_DRACO);
        EXPECT_EQ(read(connection, request).codecs, Numbers{draco});
        request.add_codecs(static_cast<v1::Codec>(number));
        EXPECT_EQ(read(connection, request).codecs, Numbers{number});
        auto reader = running.client.read_recording(id, 1);
        for (const Particles& particles : frames_) {
            const auto frame = reader.next();
            ASSERT_TRUE(frame);
            for (const auto& brick : frame->bricks) EXPECT_EQ(brick->codec, codec);
            EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
        }
    }
}

TEST_F(Codecs, OfRecordingsThatAreEncodedAgainChangeNoMesh) {
    RunningServer running(options());
    const client::Connection connection(running.server.address());
    const std::string id = recorded(running, frames_);
    grpc::ClientContext context;
    client::add_session_id(context, id);
    const auto call = connection.recordings->ReadRecording(&context, request_for(id));
    client::FrameReceiver receiver(true);
    std::vector<client::ReceivedFrame> received;
    for (v1::WatchResponse response; call->Read(&response);)
        if (auto frame = receiver.take(response)) received.push_back(std::move(*frame));
    EXPECT_TRUE(call->Finish().ok());
    ASSERT_EQ(received.size(), frames_.size());
    auto as_recorded = running.client.read_recording(id, 1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        const Mesh mesh = received[i].mesh();
        const Mesh recorded_mesh = as_recorded.next()->mesh();
        EXPECT_EQ(mesh_sha256(mesh), local_sha256(frames_[i]));
        EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(mesh.normals)),
                                       std::as_bytes(std::span(recorded_mesh.normals))));
    }
}

}  // namespace
}  // namespace meniscus::server::test
