// A server that records, for tests of what it offers.
#pragma once

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

#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "observation/metrics.hpp"
#include "recording/recording_entries.hpp"
#include "recording/recording_file.hpp"
#include "running_server.hpp"
#include "sample_files.hpp"
#include "sessions/sending/frame_encoder.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {

using client::RecordingInfo;

/// A hang guard bounds it.
inline bool becomes(const std::function<bool()>& condition) {
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > guard) return false;
        std::this_thread::yield();
    }
    return true;
}

inline std::uint64_t index_of(std::size_t frame) {
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
    /// The session's recording, once this number of its frames has been written.
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

inline std::vector<std::uint64_t> indices(client::RecordingReader reader) {
    std::vector<std::uint64_t> indices;
    while (const auto frame = reader.next()) indices.push_back(frame->index);
    return indices;
}

/// The status of reading a recording to its end, by a call of this metadata.
inline grpc::Status status_of(const RunningServer& running, const v1::ReadRecordingRequest& request,
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

inline grpc::Status deletion_status(const RunningServer& running, const std::string& id, std::uint32_t number) {
    const client::Connection connection(running.server.address());
    grpc::ClientContext context;
    connection.add_metadata(context, id);
    v1::DeleteRecordingRequest request;
    request.set_session_id(id);
    request.set_number(number);
    v1::DeleteRecordingResponse response;
    return connection.recordings->DeleteRecording(&context, request, &response);
}

inline v1::ReadRecordingRequest request_for(const std::string& id, std::uint32_t number = 1) {
    v1::ReadRecordingRequest request;
    request.set_session_id(id);
    request.set_number(number);
    return request;
}

}  // namespace meniscus::server::test
