#include "rpc/bad_input/case.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "conversion/particle_arrays.hpp"

namespace meniscus::server::test {

ServerOptions bad_input_options(const std::filesystem::path& recordings) {
    ServerOptions options = test_options();
    options.recording.directory = recordings;
    options.limits.sessions = 3;
    options.limits.watchers_per_session = 2;
    options.limits.particles_per_frame = 1'000'000;
    options.limits.bytes_per_session = 12'000'000;
    options.limits.chunks_per_frame = 1000;
    return options;
}

std::function<grpc::Status(RunningServer&)> after_a_good_frame(std::function<void(RawStream&)> send) {
    return [send = std::move(send)](RunningServer& running) {
        const CaseSession session(running);
        RawStream stream(running.server.address(), session.id);
        stream.send_begin(good_frame, 0);
        stream.send_end();
        send(stream);
        stream.call->WritesDone();
        grpc::Status status = stream.finish();
        EXPECT_EQ(stream.answered, status.ok() ? 2 : 1);
        return status;
    };
}

v1::StreamRequest frame_begin(std::uint64_t particles, bool has_levels) {
    v1::StreamRequest request;
    request.mutable_frame_begin()->set_frame_index(good_frame + 1);
    request.mutable_frame_begin()->set_particle_count(particles);
    *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, has_levels);
    return request;
}

v1::StreamRequest chunk_of(std::string bytes) {
    v1::StreamRequest request;
    request.mutable_frame_chunk()->set_data(std::move(bytes));
    return request;
}

}  // namespace meniscus::server::test
