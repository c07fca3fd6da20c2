// The client library with an older server, which knows Draco alone and refuses other codecs.
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording_service.grpc.pb.h"
#include "meniscus/v1/server_service.grpc.pb.h"
#include "meniscus/v1/surface_service.grpc.pb.h"

namespace meniscus::server::test {
namespace {

constexpr std::uint64_t shown_index = 3;

grpc::Status refusal_of(const google::protobuf::RepeatedField<int>& codecs) {
    for (const int codec : codecs)
        if (codec != v1::CODEC_DRACO)
            return {grpc::StatusCode::INVALID_ARGUMENT, "codecs has the value " + std::to_string(codec)};
    return codecs.empty() ? grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "no codec is named") : grpc::Status::OK;
}

/// An empty mesh.
template <class Writer, class Response>
void show(Writer& writer, Response response) {
    v1::MeshBegin& mesh = *response.mutable_mesh_begin();
    mesh.set_frame_index(shown_index);
    mesh.set_cell_size(1.0);
    mesh.set_offset_bits(6);
    mesh.set_brick_cells(64);
    writer.Write(response);
    response.Clear();
    response.mutable_frame_statistics()->set_frame_index(shown_index);
    writer.Write(response);
}

class Description final : public v1::ServerService::Service {
public:
    grpc::Status GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*,
                               v1::GetServerInfoResponse* response) override {
        ++asked;
        response->add_codecs(v1::CODEC_DRACO);
        response->add_codecs(static_cast<v1::Codec>(99));  // of a version that this client does not know either
        return grpc::Status::OK;
    }

    std::atomic<int> asked{0};
};

class Surfaces final : public v1::SurfaceService::Service {
public:
    grpc::Status Watch(grpc::ServerContext* context, const v1::WatchRequest* request,
                       grpc::ServerWriter<v1::WatchResponse>* writer) override {
        return answer(*context, *request, *writer);
    }
    grpc::Status Snapshot(grpc::ServerContext* context, const v1::SnapshotRequest* request,
                          grpc::ServerWriter<v1::WatchResponse>* writer) override {
        return answer(*context, *request, *writer);
    }
    grpc::Status Stream(grpc::ServerContext*,
                        grpc::ServerReaderWriter<v1::StreamResponse, v1::StreamRequest>* stream) override {
        v1::StreamRequest request;
        stream->Read(&request);
        if (auto status = refusal_of(request.open().codecs()); !status.ok()) return status;
        while (stream->Read(&request))
            if (request.has_frame_end()) show(*stream, v1::StreamResponse());
        return grpc::Status::OK;
    }

private:
    template <class Request>
    static grpc::Status answer(grpc::ServerContext& context, const Request& request,
                               grpc::ServerWriter<v1::WatchResponse>& writer) {
        if (auto status = refusal_of(request.codecs()); !status.ok()) return status;
        context.AddInitialMetadata("x-session-id", request.session_id());
        writer.SendInitialMetadata();
        show(writer, v1::WatchResponse());
        return grpc::Status::OK;
    }
};

class Recordings final : public v1::RecordingService::Service {
public:
    grpc::Status ReadRecording(grpc::ServerContext*, const v1::ReadRecordingRequest* request,
                               grpc::ServerWriter<v1::WatchResponse>* writer) override {
        if (auto status = refusal_of(request->codecs()); !status.ok()) return status;
        show(*writer, v1::WatchResponse());
        return grpc::Status::OK;
    }
};

class DracoServer : public testing::Test {
protected:
    DracoServer() {
        grpc::ServerBuilder builder;
        builder.AddListeningPort(address, grpc::InsecureServerCredentials());
        builder.RegisterService(&service);
        builder.RegisterService(&surfaces);
        builder.RegisterService(&recordings);
        running = builder.BuildAndStart();
    }
    ~DracoServer() override { running->Shutdown(); }

    const std::string address =
        "unix:" +
        (std::filesystem::temp_directory_path() / ("meniscus-draco-server-" + std::to_string(::getpid()))).string();
    const std::string id = client::new_session_id();
    Description service;
    Surfaces surfaces;
    Recordings recordings;
    std::unique_ptr<grpc::Server> running;
};

TEST_F(DracoServer, IsNamedDracoAloneAndAskedOnceForWhatItOffers) {
    client::Client client(address);
    EXPECT_EQ(client.watch(id).next()->index, shown_index);
    EXPECT_EQ(client.watch(id, {.codec = Codec::lattice_packed}).next()->index, shown_index);
    EXPECT_EQ(client.watch(id, {.codec = Codec::draco}).next()->index, shown_index);
    EXPECT_EQ(client.snapshot(id)->index, shown_index);
    EXPECT_EQ(client.read_recording(id, 1).next()->index, shown_index);
    auto stream = client.stream(id);
    stream.push(ParticleFrame(), shown_index, 0.0);
    EXPECT_EQ(stream.next()->index, shown_index);
    EXPECT_EQ(service.asked, 1);
}

TEST_F(DracoServer, IsNotAskedByThoseWhoWantNoMeshOrDraco) {
    client::Client client(address);
    auto pushing = client.stream(id, {.receive_meshes = false});
    EXPECT_EQ(client.snapshot(id, {.codec = Codec::draco})->index, shown_index);
    EXPECT_EQ(service.asked, 0);
}

}  // namespace
}  // namespace meniscus::server::test
