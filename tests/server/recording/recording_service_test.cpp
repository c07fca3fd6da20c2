// Recordings as the server that made them offers them.
#include "recording/recording_service.hpp"

#include "cli/commands/command_line.hpp"
#include "meniscus/mesh_normals.hpp"

namespace meniscus::server::test {
namespace {

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

TEST_F(RecordingService, LeavesNormalsToAReceiverThatWantsItsOwn) {
    RunningServer running(options());
    const std::string id = recorded(running, {frames_[0]});
    const Mesh recorded_ones = running.client.read_recording(id, 1).next()->mesh();
    Mesh own = running.client.read_recording(id, 1, {.normals_by = client::NormalsBy::receiver}).next()->mesh();
    EXPECT_NE(own.normals, recorded_ones.normals);
    const Array<Normal> normals = own.normals;
    compute_normals(own);
    EXPECT_EQ(normals, own.normals);
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

TEST_F(RecordingService, DeletesWhatItsCallerNamesAndNothingElse) {
    RunningServer running(options());
    const std::string id = recorded(running, frames_);
    const std::string other = recorded(running, {wave(6, 0.0)});
    running.client.create_session(id, settings());
    stream(running.client, id, {wave(6, 0.0)});
    recording(running.client, id, 1, 2);
    running.client.delete_recording(id, 1);
    EXPECT_FALSE(std::filesystem::exists(file(id)));
    EXPECT_TRUE(std::filesystem::exists(file(id, 2)));
    EXPECT_EQ(running.client.recordings().size(), 2U);
    EXPECT_EQ(status_of(running, request_for(id)).error_code(), grpc::StatusCode::NOT_FOUND);
    EXPECT_EQ(deletion_status(running, id, 1).error_code(), grpc::StatusCode::NOT_FOUND) << "it has gone";
    running.client.delete_recording(other, 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / other)) << "the session's folder goes with its last recording";
}

TEST_F(RecordingService, DeletesNothingThatIsBeingWritten) {
    RunningServer running(options());
    const std::string id = running.session();
    stream(running.client, id, frames_);
    recording(running.client, id, frames_.size());
    const grpc::Status status = deletion_status(running, id, 1);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
    EXPECT_EQ(status.error_message(), "recording 1 of session " + id +
                                          " is not deleted: it is being written, until its session ends or sends a "
                                          "frame whose index does not rise");
    EXPECT_EQ(indices(running.client.read_recording(id, 1)).size(), frames_.size());
    running.client.delete_session(id);
    EXPECT_TRUE(becomes([&] { return deletion_status(running, id, 1).ok(); }));
}

TEST_F(RecordingService, DeletesNothingThatIsBeingReadAndAllThatHasBeen) {
    RunningServer running(options());
    const std::string id = recorded(running, std::vector<Particles>(12, spray(12)));
    {
        auto stalled = running.client.read_recording(id, 1);
        ASSERT_TRUE(stalled.next());
        const grpc::Status status = deletion_status(running, id, 1);
        EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
        EXPECT_NE(status.error_message().find("is not deleted: it is being read; try again later"), std::string::npos)
            << status.error_message();
        EXPECT_TRUE(std::filesystem::exists(file(id)));
    }
    EXPECT_TRUE(becomes([&] { return deletion_status(running, id, 1).ok(); }));
    // A reader that has come to a recording's end may delete it at once.
    for (int i = 0; i < 8; ++i) {
        const std::string read = recorded(running, {wave(6, 0.0)});
        EXPECT_EQ(indices(running.client.read_recording(read, 1)).size(), 1U);
        EXPECT_TRUE(deletion_status(running, read, 1).ok());
    }
}

TEST_F(RecordingService, DeletesForTheCommandLine) {
    RunningServer running(options());
    const std::string first = recorded(running, {wave(6, 0.0)});
    const std::string second = recorded(running, {wave(6, 0.0)});
    const auto run = [&](std::vector<const char*> arguments) {
        arguments.insert(arguments.begin(), {"meniscus", "recordings"});
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int code = cli::run(static_cast<int>(arguments.size()), arguments.data());
        return std::to_string(code) + " " + testing::internal::GetCapturedStdout() +
               testing::internal::GetCapturedStderr();
    };
    const char* const server = running.server.address().c_str();
    for (const char* wrong : {"", "1", "/1", "x/", "x/0", "x/1x", "x/-1", "x/4294967296", "x/1/2"}) {
        const std::string said = run({"--server", server, "--delete", (first + "/1").c_str(), wrong});
        EXPECT_TRUE(said.starts_with("2 meniscus: --delete")) << said;
    }
    EXPECT_TRUE(run({"--delete", "x/1"}).starts_with("2 ")) << "of a server alone";
    EXPECT_EQ(running.client.recordings().size(), 2U) << "what is wrong is found before anything is deleted";
    std::string said = run({"--server", server, "--delete", (first + "/1").c_str(), (second + "/1").c_str()});
    EXPECT_TRUE(said.starts_with("0 ")) << said;
    for (const std::string& id : {first, second})
        EXPECT_NE(said.find("deleted " + id + "/1\n"), std::string::npos) << said;
    EXPECT_TRUE(running.client.recordings().empty());
    said = run({"--server", server, "--delete", (first + "/1").c_str()});
    EXPECT_NE(said.find("no recording 1 of session " + first), std::string::npos) << said;
    EXPECT_FALSE(said.starts_with("0 ")) << said;
}

TEST_F(RecordingService, DeletesAtItsStartWhatAnEarlierServerShouldHave) {
    std::string old;
    std::string shorter;
    std::string kept;
    {
        RunningServer earlier(options());
        old = recorded(earlier, frames_);
        shorter = recorded(earlier, {wave(6, 0.0)});
        kept = recorded(earlier, frames_);
    }
    std::filesystem::last_write_time(file(old), std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    ServerOptions tidy = options();
    tidy.recording.retention = {.min_frames = 2, .max_age = std::chrono::hours(1)};
    RunningServer running(tidy);
    EXPECT_TRUE(becomes(
        [&] { return !std::filesystem::exists(folder_ / old) && !std::filesystem::exists(folder_ / shorter); }));
    const std::vector<RecordingInfo> left = running.client.recordings();
    ASSERT_EQ(left.size(), 1U);
    EXPECT_EQ(left[0].session_id, kept);
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
    ada.delete_session(id);
    EXPECT_TRUE(becomes([&] { return !recording(ada, id, 1).being_written; }));
    const auto refused = [&](const std::string& name) {
        try {
            as(name).delete_recording(id, 1);
        } catch (const client::ServerError& error) {
            return error.status();
        }
        return std::string("OK");
    };
    EXPECT_EQ(refused("ben"), "NOT_FOUND");
    EXPECT_EQ(refused("eve"), "PERMISSION_DENIED");
    EXPECT_EQ(refused("ada"), "OK") << "it is of her session";
    EXPECT_EQ(refused("root"), "NOT_FOUND");
    const std::string another = client::new_session_id();
    ada.create_session(another, settings());
    stream(ada, another, {wave(6, 0.0)});
    ada.delete_session(another);
    EXPECT_TRUE(becomes([&] { return !recording(ada, another, 1).being_written; }));
    as("root").delete_recording(another, 1);
    EXPECT_TRUE(ada.recordings().empty());
    const auto anonymous = [&] { client::Client(server.address()).recordings(); };
    EXPECT_THROW(anonymous(), client::ServerError);
}

}  // namespace
}  // namespace meniscus::server::test
