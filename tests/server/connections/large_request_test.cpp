// Requests that are larger than any: gRPC would receive them whole.
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "connection/connection.hpp"
#include "conversion/particle_arrays.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
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

/// One call of a connection; its request is up to the test.
class Call {
public:
    Call(const client::Connection& connection, const char* method, const std::string& session = {})
        : stub_(connection.channel) {
        if (!session.empty()) client::add_session_id(context_, session);
        call_ = stub_.PrepareCall(&context_, method, &queue_);
        call_->StartCall(this);
        wait();
    }

    /// False if the call ended first.
    bool send(const grpc::ByteBuffer& message) {
        call_->WriteLast(message, {}, this);
        return wait();
    }
    grpc::Status end() {
        grpc::ByteBuffer answer;
        do call_->Read(&answer, this);
        while (wait());
        grpc::Status status;
        call_->Finish(&status, this);
        wait();
        return status;
    }

private:
    bool wait() {
        void* tag = nullptr;
        bool ok = false;
        return queue_.Next(&tag, &ok) && ok;
    }

    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    grpc::CompletionQueue queue_;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

/// Of a request without fields.
grpc::ByteBuffer no_bytes() {
    const grpc::Slice empty;
    return {&empty, 1};
}

/// This number of mebibytes, all of them the same one.
grpc::ByteBuffer mebibytes(std::size_t count) {
    static const std::vector<char> bytes(std::size_t{1} << 20, '\0');
    const std::vector<grpc::Slice> slices(count, grpc::Slice(bytes.data(), bytes.size(), grpc::Slice::STATIC_SLICE));
    return {slices.data(), slices.size()};
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
        Call call(connection, method, method == list_sessions ? std::string() : id);
        call.send(mebibytes(512));
        EXPECT_EQ(call.end().error_code(), grpc::StatusCode::CANCELLED) << method;
    }
    EXPECT_LT(peak_of(process.pid()) - before, std::size_t{128} << 20U);
    Call next(connection, list_sessions);
    next.send(no_bytes());
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
    Call late(connection, list_sessions);
    request.mutable_frame_begin()->set_particle_count(10'000'000);
    *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
    upload->Write(request);
    request.mutable_frame_chunk()->set_data(std::string(1'000'000, '\0'));
    for (int i = 0; i < 120; ++i) upload->Write(request);
    late.send(no_bytes());
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
