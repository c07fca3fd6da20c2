// A session's newest mesh as a page: a snapshot, made by a call as native gRPC makes it, with its rights and limits.
// For users that fetch latest.glb: with a browser, curl, or any program that reads glTF and knows nothing of gRPC.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/v1/session_service.pb.h"
#include "sessions/limits/retained_memory.hpp"
#include "web/bridged_call.hpp"
#include "web/mesh_request.hpp"
#include "web/page.hpp"

namespace meniscus::server {

/// Says what became of a call about a mesh that is not shown.
Page page_of(const grpc::Status& status);

/// Used and answered on the context's one thread; bricks are decoded on the worker's.
class LatestMesh : public std::enable_shared_from_this<LatestMesh> {
public:
    struct Means {
        std::shared_ptr<grpc::Channel> channel;
        std::shared_ptr<SharedMemory> memory;  ///< that the file and its making are charged to; may be none
        boost::asio::thread_pool& worker;      ///< outlives the context's work
    };
    using Metadata = std::vector<std::pair<std::string, std::string>>;

    /// metadata: of the calls, but the session's id. if_none_match: the header. answered: is called once, always.
    LatestMesh(std::shared_ptr<boost::asio::io_context> context, Means means, MeshRequest asked, Metadata metadata,
               std::string if_none_match, std::function<void(Page page)> answered);

    void start();
    /// The answer follows soon; nobody need see it.
    void cancel();

private:
    using OnMessage = void (LatestMesh::*)(const grpc::ByteBuffer& message);
    using OnEnd = void (LatestMesh::*)(const grpc::Status& status);

    void call(std::string_view method, const google::protobuf::MessageLite& request, OnMessage on_message,
              OnEnd on_end);
    void take_part(const grpc::ByteBuffer& message);
    /// The mesh is announced. Returns an answer if the rest is not needed, or not possible.
    std::optional<Page> early_answer(const v1::MeshBegin& mesh);
    void end_snapshot(const grpc::Status& status);
    void take_description(const grpc::ByteBuffer& message);
    void end_description(const grpc::Status& status);
    /// The page with the mesh decoded, made on the worker's thread.
    Page decoded() const;
    void answer(Page page);

    const std::shared_ptr<boost::asio::io_context> context_;
    const boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
    const Means means_;
    const MeshRequest asked_;
    const Metadata metadata_;
    const std::string if_none_match_;
    std::function<void(Page)> answered_;
    std::shared_ptr<BridgedCall> call_;  ///< until its end
    std::vector<grpc::ByteBuffer> messages_;
    bool announced_ = false;     ///< the mesh
    std::string instance_;       ///< of the session, once announced
    std::optional<Page> early_;  ///< the answer, while the call ends
    RetainedMemory memory_;      ///< for the file and its making
    v1::UpAxis up_ = v1::UP_AXIS_UNSPECIFIED;
    std::atomic<bool> canceled_{false};
};

}  // namespace meniscus::server
