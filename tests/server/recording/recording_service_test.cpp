// Recordings as the server that made them offers them.
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "formats/recording.hpp"
#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "recording/recording_entries.hpp"
#include "recording/recording_file.hpp"
#include "running_server.hpp"
#include "sample_files.hpp"
#include "sessions/frame_encoder.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

using client::RecordingInfo;

/// A hang guard bounds it.
bool becomes(const std::function<bool()>& condition) {
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > guard) return false;
        std::this_thread::yield();
    }
    return true;
}

std::uint64_t index_of(std::size_t frame) {
    return 10 + 3 * frame;
}

class RecordingService : public testing::Test {
protected:
    ServerOptions options() const {
        ServerOptions options = test_options();
        options.recording.directory = folder_.path();
        return options;
    }

    static void stream(client::Client& client, const std::string& id, const std::vector<Particles>& frames) {
        auto stream = client.stream(id);
        for (std::size_t i = 0; i < frames.size(); ++i)
            stream.push(frames[i].view(), index_of(i), 0.5 * static_cast<double>(i));
        stream.finish();
        while (stream.next()) {
        }
    }
    /// Of the session, once so many frames of it have been written.
    static RecordingInfo recording(client::Client& client, const std::string& id, std::uint64_t frames,
                                   std::uint32_t number = 1) {
        RecordingInfo found;
        EXPECT_TRUE(becomes([&] {
            for (const RecordingInfo& info : client.recordings())
                if (info.session_id == id && info.number == number) found = info;
            return found.frames >= frames;
        }));
        return found;
    }
    /// A session of these frames, recorded.
    static std::string recorded(RunningServer& running, const std::vector<Particles>& frames) {
        std::string id = running.session();
        stream(running.client, id, frames);
        recording(running.client, id, frames.size());
        running.client.delete_session(id);
        EXPECT_TRUE(becomes([&] { return !recording(running.client, id, frames.size()).being_written; }));
        return id;
    }
    std::filesystem::path file(const std::string& id, int number = 1) const {
        return folder_ / id / ("00000" + std::to_string(number) + ".recording");
    }

    const meniscus::test::TemporaryDirectory folder_;
    const std::vector<Particles> frames_{wave(8, 0.0), quantized(wave(8, 1.0)), {}, wave(24, 3.0)};
};

std::vector<std::uint64_t> indices(client::RecordingReader reader) {
    std::vector<std::uint64_t> indices;
    while (const auto frame = reader.next()) indices.push_back(frame->index);
    return indices;
}

/// The status of reading a recording to its end, by a call of this metadata.
grpc::Status status_of(const RunningServer& running, const v1::ReadRecordingRequest& request,
                       const std::string& token = {}) {
    const client::Connection connection(running.server.address(), {.token = token});
    grpc::ClientContext context;
    connection.add_metadata(context, request.session_id());
    const auto call = connection.recordings->ReadRecording(&context, request);
    v1::WatchResponse ignored;
    while (call->Read(&ignored)) {
    }
    return call->Finish();
}

v1::ReadRecordingRequest request_for(const std::string& id, std::uint32_t number = 1) {
    v1::ReadRecordingRequest request;
    request.set_session_id(id);
    request.set_number(number);
    return request;
}

TEST_F(RecordingService, TellsWhatThereIs) {
    RunningServer running(options());
    EXPECT_TRUE(running.client.recordings().empty());
    const std::string id = running.session();
    stream(running.client, id, frames_);
    const RecordingInfo open = recording(running.client, id, frames_.size());
    EXPECT_TRUE(open.being_written);
    running.client.delete_session(id);
    EXPECT_TRUE(becomes([&] { return !recording(running.client, id, 1).being_written; }));
    running.client.create_session(id, settings());
    stream(running.client, id, {frames_[0]});
    recording(running.client, id, 1, 2);
    const std::vector<RecordingInfo> all = running.client.recordings();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].number, 2U) << "the newest first";
    EXPECT_EQ(all[0].frames, 1U);
    EXPECT_EQ(all[1].number, 1U);
    EXPECT_EQ(all[1].session_id, id);
    EXPECT_EQ(all[1].frames, frames_.size());
    EXPECT_EQ(all[1].first_frame_index, index_of(0));
    EXPECT_EQ(all[1].last_frame_index, index_of(3));
    EXPECT_EQ(all[1].bytes, std::filesystem::file_size(file(id)));
    EXPECT_FALSE(all[1].damaged);
    EXPECT_LT(std::chrono::system_clock::now() - all[1].started_at, std::chrono::hours(1));
    EXPECT_LE(all[1].started_at, all[0].started_at);
}

TEST_F(RecordingService, SendsTheMeshesThatWereReconstructed) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    auto reader = running.client.read_recording(id, 1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        const auto frame = reader.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->index, index_of(i));
        EXPECT_EQ(frame->simulation_time, 0.5 * static_cast<double>(i));
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(frames_[i]));
    }
    EXPECT_FALSE(reader.next());
}

TEST_F(RecordingService, SendsThePartThatIsAskedFor) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    const auto read = [&](std::uint64_t position, std::uint64_t count) {
        return indices(running.client.read_recording(id, 1, {.position = position, .count = count}));
    };
    EXPECT_EQ(read(0, 1), (std::vector<std::uint64_t>{10}));
    EXPECT_EQ(read(1, 2), (std::vector<std::uint64_t>{13, 16}));
    EXPECT_EQ(read(3, 0), (std::vector<std::uint64_t>{19}));
    EXPECT_EQ(read(2, std::numeric_limits<std::uint64_t>::max()), (std::vector<std::uint64_t>{16, 19}));
    EXPECT_THROW(read(4, 1), InvalidInput);
}

TEST_F(RecordingService, SendsSprayToThoseWhoAskForIt) {
    InputFrame input(nullptr);
    input.index = 7;
    ReconstructedFrame frame;
    frame.index = 7;
    frame.mesh.cell_size = 0.1;
    frame.mesh.offset_bits = 6;
    frame.mesh.spray.push_back({1.0F, 2.0F, 3.0F});
    WorkerPool workers(1);
    ScratchPool scratch;
    const auto encoded =
        encode_frame(frame, {.position_bits = 6, .normal_bits = 8}, nullptr, workers, scratch, nullptr);
    const std::string id = client::new_session_id();
    std::filesystem::create_directories(folder_ / id);
    {
        const RecordingBytes particles = recorded_particles(input, 1);
        const RecordingBytes mesh = recorded_mesh(*encoded);
        std::ofstream(file(id), std::ios::binary) << recording_begin(id, settings(), 1) << particles.entry
                                                  << particles.messages << mesh.entry << mesh.messages;
    }
    RunningServer running(options());
    const auto read = [&](bool spray) {
        const auto read_frame = running.client.read_recording(id, 1, {.spray = spray}).next();
        EXPECT_TRUE(read_frame);
        return read_frame ? read_frame->spray : std::vector<Point>();
    };
    EXPECT_EQ(read(true), (std::vector<Point>{{1.0F, 2.0F, 3.0F}}));
    EXPECT_TRUE(read(false).empty());
}

TEST_F(RecordingService, ReadsWhileASessionIsBeingRecorded) {
    RunningServer running(options());
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    for (std::uint64_t i = 0; i < 3; ++i) {
        stream.push(wave(8, static_cast<double>(i)).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        EXPECT_EQ(recording(running.client, id, i + 1).last_frame_index, i);
        auto reader = running.client.read_recording(id, 1, {.position = i});
        EXPECT_EQ(mesh_sha256(reader.next()->mesh()), local_sha256(wave(8, static_cast<double>(i))));
    }
}

TEST_F(RecordingService, OffersWhatAnEarlierServerLeft) {
    std::string id;
    {
        RunningServer earlier(options());
        id = recorded(earlier, frames_);
    }
    RunningServer running(options());
    EXPECT_EQ(indices(running.client.read_recording(id, 1)).size(), frames_.size()) << "without having been listed";
}

TEST_F(RecordingService, LeavesOutAFrameThatTheFileDoesNotHoldToItsEnd) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    std::filesystem::resize_file(file(id), std::filesystem::file_size(file(id)) - 1);
    const RecordingInfo cut = running.client.recordings().at(0);
    EXPECT_EQ(cut.frames, 3U);
    EXPECT_FALSE(cut.damaged);
    EXPECT_EQ(indices(running.client.read_recording(id, 1)), (std::vector<std::uint64_t>{10, 13, 16}));
}

TEST_F(RecordingService, SaysWhereDamageIsAndServesWhatIsBeforeIt) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    std::ofstream(file(id), std::ios::binary | std::ios::app) << "\x05nonsense";
    const RecordingInfo damaged = running.client.recordings().at(0);
    EXPECT_TRUE(damaged.damaged);
    EXPECT_EQ(damaged.frames, 4U);
    EXPECT_EQ(indices(running.client.read_recording(id, 1)).size(), 4U);
}

TEST_F(RecordingService, EndsWithDataLossWithinAFrameThatIsDamaged) {
    RunningServer running(options());
    const std::string id = recorded(running, {wave(8, 0.0)});
    // The first length of the mesh's messages: behind its entry, which is known from here on.
    const formats::Recording opened(file(id));
    running.client.recordings();
    std::fstream bytes(file(id), std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekp(static_cast<std::streamoff>(opened.frames()[0].mesh->first));
    bytes << "\xff\xff\xff\xff\x7f";
    bytes.close();
    const grpc::Status status = status_of(running, request_for(id));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::DATA_LOSS);
    EXPECT_NE(status.error_message().find("recording 1 of session " + id + " is damaged at frame 10"),
              std::string::npos)
        << status.error_message();
    EXPECT_EQ(status.error_message().find(folder_.path().string()), std::string::npos) << "a path of the server";
}

TEST_F(RecordingService, SendsNothingOfAFrameWhoseBytesHaveChanged) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    const files::RecordedRange mesh = *formats::Recording(file(id)).frames()[1].mesh;
    std::fstream bytes(file(id), std::ios::binary | std::ios::in | std::ios::out);
    const auto middle = static_cast<std::streamoff>(mesh.first + mesh.size / 2);
    bytes.seekg(middle);
    std::string four(4, '\0');
    bytes.read(four.data(), 4);
    for (char& byte : four) byte = static_cast<char>(~byte);
    bytes.seekp(middle);
    bytes << four;
    bytes.close();
    auto reader = running.client.read_recording(id, 1);
    EXPECT_EQ(reader.next()->index, 10U);
    EXPECT_THROW(reader.next(), client::ServerError);
    const grpc::Status status = status_of(running, request_for(id));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::DATA_LOSS);
    EXPECT_NE(status.error_message().find("is damaged at frame 13"), std::string::npos) << status.error_message();
    EXPECT_EQ(indices(running.client.read_recording(id, 1, {.position = 2})), (std::vector<std::uint64_t>{16, 19}))
        << "the frames behind it are whole";
}

TEST_F(RecordingService, DoesNotFindWhatHasGoneOrIsNoRecording) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    const std::string other = client::new_session_id();
    std::filesystem::create_directory(folder_ / other);
    std::filesystem::copy_file(file(id), file(other));
    std::ofstream(folder_ / other / "000002.recording") << "no recording";
    std::ofstream(folder_ / other / "3.recording") << "no recording";
    std::filesystem::create_directory(folder_ / other / "000004.recording");
    EXPECT_EQ(running.client.recordings().size(), 1U);
    for (const std::uint32_t number : {0U, 1U, 2U, 3U, 4U, 5U})
        EXPECT_EQ(status_of(running, request_for(other, number)).error_code(), grpc::StatusCode::NOT_FOUND) << number;
    std::filesystem::remove(file(id));
    EXPECT_EQ(status_of(running, request_for(id)).error_code(), grpc::StatusCode::NOT_FOUND);
    EXPECT_TRUE(running.client.recordings().empty());
}

TEST_F(RecordingService, ReadsAFileThatHasTakenAnothersPlace) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    std::filesystem::remove(file(id));
    running.client.create_session(id, settings());
    stream(running.client, id, {wave(6, 0.0), wave(6, 1.0)});
    running.client.delete_session(id);
    EXPECT_TRUE(becomes([&] {
        return indices(running.client.read_recording(id, 1)) == std::vector<std::uint64_t>{10, 13};
    }));
}

TEST_F(RecordingService, RefusesReadersPastTheLimitUntilOneLeaves) {
    ServerOptions limited = options();
    limited.limits.recording_readers = 2;
    limited.http = "127.0.0.1:0";
    RunningServer running(limited);
    const std::string id = recorded(running, std::vector<Particles>(12, spray(12)));
    {
        auto first = running.client.read_recording(id, 1);
        auto second = running.client.read_recording(id, 1);
        ASSERT_TRUE(first.next() && second.next());
        EXPECT_EQ(scrape_until(running.server.http_address(), "meniscus_recording_readers", 2)
                      .at("meniscus_recording_readers"),
                  2);
        const grpc::Status status = status_of(running, request_for(id));
        EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
        EXPECT_NE(status.error_message().find("2 recordings are being read; the server takes at most 2 readers"),
                  std::string::npos);
        EXPECT_EQ(running.client.recordings().size(), 1U);
        scrape_until(running.server.http_address(), "meniscus_refusals_total{name=\"\",reason=\"recording_readers\"}",
                     1);
    }
    EXPECT_TRUE(becomes([&] { return status_of(running, request_for(id)).ok(); }));
}

TEST_F(RecordingService, EndsAReaderThatStopsReadingAndGivesItsPlaceToAnother) {
    ServerOptions limited = options();
    limited.limits.recording_readers = 1;
    limited.limits.reader_patience = std::chrono::milliseconds(300);
    RunningServer running(limited);
    const std::string id = recorded(running, std::vector<Particles>(12, spray(24)));
    auto stalled = running.client.read_recording(id, 1);
    ASSERT_TRUE(stalled.next());
    EXPECT_TRUE(becomes([&] { return status_of(running, request_for(id)).ok(); }));
    try {
        while (stalled.next()) {
        }
        FAIL() << "ended well";
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.status(), "CANCELLED");
    }
}

TEST_F(RecordingService, EndsItsReadersWhenTheServerGoesDown) {
    ServerOptions hasty = options();
    hasty.shutdown_grace = std::chrono::milliseconds(400);
    RunningServer running(hasty);
    const std::string id = recorded(running, std::vector<Particles>(12, spray(12)));
    auto reads = running.client.read_recording(id, 1);
    auto stalled = running.client.read_recording(id, 1);
    ASSERT_TRUE(reads.next());
    ASSERT_TRUE(stalled.next());
    std::thread down([&] { running.server.shutdown(); });
    try {
        while (reads.next()) {
        }
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.status(), "UNAVAILABLE");
    }
    down.join();
}

TEST_F(RecordingService, IsNotThereWhereNothingIsRecorded) {
    ServerOptions observed = test_options();
    observed.http = "127.0.0.1:0";
    RunningServer running(observed);
    try {
        running.client.recordings();
        ADD_FAILURE();
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.status(), "UNIMPLEMENTED");
        EXPECT_NE(std::string(error.what()).find("this server keeps no recordings: meniscusd --record DIR does"),
                  std::string::npos);
    }
    EXPECT_EQ(status_of(running, request_for(client::new_session_id())).error_code(), grpc::StatusCode::UNIMPLEMENTED);
    scrape_until(running.server.http_address(), "meniscus_refusals_total{name=\"\",reason=\"unimplemented\"}", 2);
}

TEST_F(RecordingService, ShowsUploadersTheirOwnAlone) {
    const TestFolder tokens;
    const auto token = [](const std::string& name) { return "token-of-" + name + "-0123456789"; };
    ServerOptions closed = options();
    closed.tokens =
        tokens.write("tokens", "uploader ada " + token("ada") + "\nuploader ben " + token("ben") + "\nwatcher eve " +
                                   token("eve") + "\nadmin root " + token("root") + "\n");
    Server server(closed);
    const auto as = [&](const std::string& name) { return client::Client(server.address(), {.token = token(name)}); };
    client::Client ada = as("ada");
    const std::string id = client::new_session_id();
    ada.create_session(id, settings());
    stream(ada, id, {wave(6, 0.0)});
    EXPECT_EQ(recording(ada, id, 1).owner, "ada");
    for (const char* name : {"ada", "eve", "root"}) {
        EXPECT_EQ(as(name).recordings().size(), 1U) << name;
        EXPECT_EQ(indices(as(name).read_recording(id, 1)).size(), 1U) << name;
    }
    EXPECT_TRUE(as("ben").recordings().empty());
    EXPECT_THROW(
        {
            try {
                as("ben").read_recording(id, 1).next();
            } catch (const client::ServerError& error) {
                EXPECT_EQ(error.status(), "NOT_FOUND");
                throw;
            }
        },
        client::ServerError);
    const auto anonymous = [&] { client::Client(server.address()).recordings(); };
    EXPECT_THROW(anonymous(), client::ServerError);
}

/// Thousands of recordings of somebody else: to look through them takes long, an answer without them does not.
class ManyRecordings : public RecordingService {
protected:
    ManyRecordings() {
        std::filesystem::create_directory(folder_ / id_);
        const std::string begin = recording_begin(id_, settings(), 0, "ada");
        for (std::uint32_t i = 1; i <= 3000; ++i) std::ofstream(folder_ / id_ / recording_file_name(i)) << begin;
        ServerOptions closed = options();
        closed.tokens = tokens_.write("tokens", "uploader ben " + token_ + "\n");
        closed.limits.recording_readers = 0;  // a call's place is free a moment after its client has its status
        server_.emplace(closed);
        connection_.emplace(server_->address(), client::ConnectionOptions{.token = token_});
        look();  // into each file, once
    }

    /// Seconds of one call of ListRecordings.
    double look() const {
        const auto begun = std::chrono::steady_clock::now();
        grpc::ClientContext context;
        connection_->add_metadata(context, {});
        v1::ListRecordingsResponse response;
        EXPECT_TRUE(connection_->recordings->ListRecordings(&context, {}, &response).ok());
        EXPECT_EQ(response.recordings_size(), 0);
        return seconds_since(begun);
    }
    static double seconds_since(std::chrono::steady_clock::time_point begun) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    }

    const TestFolder tokens_;
    const std::string token_ = "token-of-ben-0123456789";
    const std::string id_ = client::new_session_id();
    std::optional<Server> server_;
    std::optional<client::Connection> connection_;
};

/// Calls of ListRecordings that wait for their answers at the same time.
class Looks {
public:
    Looks(const client::Connection& connection, std::size_t count) : calls_(count) {
        for (Call& call : calls_) {
            connection.add_metadata(call.context, {});
            connection.recordings->async()->ListRecordings(&call.context, &request_, &call.response,
                                                           [&call](const grpc::Status& status) { call.end(status); });
        }
    }
    std::vector<grpc::StatusCode> ends() {
        std::vector<grpc::StatusCode> codes;
        for (Call& call : calls_) codes.push_back(call.ended.get_future().get());
        return codes;
    }
    void cancel() {
        for (Call& call : calls_) call.context.TryCancel();
    }

private:
    struct Call {
        void end(const grpc::Status& status) { ended.set_value(status.error_code()); }
        grpc::ClientContext context;
        v1::ListRecordingsResponse response;
        std::promise<grpc::StatusCode> ended;
    };
    const v1::ListRecordingsRequest request_;
    std::deque<Call> calls_;
};

TEST_F(ManyRecordings, AreLookedThroughOnceForAllWhoWait) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    Looks looks(*connection_, 500);
    for (const grpc::StatusCode code : looks.ends()) EXPECT_EQ(code, grpc::StatusCode::OK);
    EXPECT_LT(seconds_since(begun), 100 * one);
}

TEST_F(ManyRecordings, AreNotLookedThroughForCallsThatHaveBeenCanceled) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    Looks looks(*connection_, 500);
    looks.cancel();
    looks.ends();
    look();
    EXPECT_LT(seconds_since(begun), 100 * one);
}

TEST_F(ManyRecordings, DoNotDelayTheServersEnd) {
    const double one = look();
    Looks looks(*connection_, 500);
    const auto begun = std::chrono::steady_clock::now();
    server_.reset();
    EXPECT_LT(seconds_since(begun), 1 + 100 * one);
    looks.ends();
}

TEST_F(ManyRecordings, AreNotLookedThroughForOneThatIsNotThere) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < 200; ++i) {
        grpc::ClientContext context;
        connection_->add_metadata(context, id_);
        const auto call = connection_->recordings->ReadRecording(&context, request_for(id_, 4000));
        v1::WatchResponse ignored;
        EXPECT_FALSE(call->Read(&ignored));
        EXPECT_EQ(call->Finish().error_code(), grpc::StatusCode::NOT_FOUND);
    }
    EXPECT_LT(seconds_since(begun), 100 * one);
}

}  // namespace
}  // namespace meniscus::server::test
