// Requests that are larger than any: gRPC would receive them whole.
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <string>

#include "connection/connection.hpp"
#include "conversion/particle_arrays.hpp"
#include "large_message.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "raw_call.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

constexpr const char* list_sessions = "/meniscus.v1.SessionService/ListSessions";

/// The most that was resident, in bytes.
std::size_t peak_of(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    std::string word;
    std::size_t kibibytes = 0;
    while (status >> word && word != "VmHWM:") {
    }
    status >> kibibytes;
    return kibibytes * 1024;
}

TEST(LargeRequest, IsCutOffLongBeforeItIsWhole) {
    Process process(on_free_port());
    const std::string address = process.address();
    const std::string id = client::new_session_id();
    client::Client(address).create_session(id, settings());
    const client::Connection connection(address);
    const std::size_t before = peak_of(process.pid());
    for (const char* method :
         {list_sessions, "/meniscus.v1.SurfaceService/Watch", "/meniscus.v1.SurfaceService/Stream"}) {
        RawCall call(connection, method, method == list_sessions ? std::string() : id);
        call.send(mebibytes_of_zeros(512));
        EXPECT_EQ(call.end().error_code(), grpc::StatusCode::CANCELLED) << method;
    }
    EXPECT_LT(peak_of(process.pid()) - before, std::size_t{128} << 20U);
    RawCall next(connection, list_sessions);
    next.send(std::string());
    EXPECT_TRUE(next.end().ok()) << "its connection is as good as before";
}

TEST(LargeRequest, IsNoneThatComesLateBesideUploadsOfItsConnection) {
    Process process(on_free_port());
    const std::string address = process.address();
    client::Client client(address);
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    const client::Connection connection(address);
    grpc::ClientContext context;
    client::add_session_id(context, id);
    const auto upload = connection.surfaces->Stream(&context);
    v1::StreamRequest request;
    request.mutable_open()->set_session_id(id);
    upload->Write(request);
    RawCall late(connection, list_sessions);
    request.mutable_frame_begin()->set_particle_count(10'000'000);
    *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
    upload->Write(request);
    request.mutable_frame_chunk()->set_data(std::string(1'000'000, '\0'));
    for (int i = 0; i < 120; ++i) upload->Write(request);
    late.send(std::string());
    const grpc::Status status = late.end();
    EXPECT_TRUE(status.ok()) << status.error_message();
    context.TryCancel();
    v1::StreamResponse response;
    while (upload->Read(&response)) {
    }
    static_cast<void>(upload->Finish());
}

}  // namespace
}  // namespace meniscus::server::test
