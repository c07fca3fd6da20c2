#include "web/latest_mesh.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>

#include "meniscus/error.hpp"
#include "meniscus/v1/session_service.pb.h"
#include "rpc/messages/wire_bytes.hpp"
#include "web/mesh_glb.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view get_session_method = "/meniscus.v1.SessionService/GetSession";

unsigned http_status_of(grpc::StatusCode code) {
    switch (code) {
        case grpc::StatusCode::INVALID_ARGUMENT:
            return 400;
        case grpc::StatusCode::UNAUTHENTICATED:
            return 401;
        case grpc::StatusCode::PERMISSION_DENIED:
            return 403;
        case grpc::StatusCode::NOT_FOUND:
            return 404;
        case grpc::StatusCode::RESOURCE_EXHAUSTED:
            return 429;
        case grpc::StatusCode::UNAVAILABLE:
        case grpc::StatusCode::CANCELLED:
            return 503;
        case grpc::StatusCode::DEADLINE_EXCEEDED:
            return 504;
        default:
            return 500;
    }
}

/// A file that this server cannot make.
constexpr unsigned insufficient_storage = 507;

Page with_tag(Page page, const std::string& tag) {
    page.cache_control = "no-cache";
    if (!tag.empty()) page.headers.emplace_back("ETag", tag);
    return page;
}

}  // namespace

Page page_of(const grpc::Status& status) {
    Page page{.status = http_status_of(status.error_code()), .body = status.error_message() + '\n'};
    if (page.status == 401) page.headers.emplace_back("WWW-Authenticate", "Bearer");
    return page;
}

LatestMesh::LatestMesh(std::shared_ptr<boost::asio::io_context> context, Means means, MeshRequest asked,
                       Metadata metadata, std::string if_none_match, std::function<void(Page)> answered)
    : context_(std::move(context)),
      work_(context_->get_executor()),
      means_(std::move(means)),
      asked_(std::move(asked)),
      metadata_(std::move(metadata)),
      if_none_match_(std::move(if_none_match)),
      answered_(std::move(answered)),
      memory_(means_.memory) {}

void LatestMesh::start() {
    call(snapshot_method, snapshot_request(asked_), &LatestMesh::take_part, &LatestMesh::end_snapshot);
}

void LatestMesh::cancel() {
    canceled_ = true;
    if (call_) call_->cancel();
}

void LatestMesh::call(std::string_view method, const google::protobuf::MessageLite& request, OnMessage on_message,
                      OnEnd on_end) {
    BridgedCall::Request bridged{.method = std::string(method), .metadata = metadata_, .timeout = {}, .message = {}};
    bridged.metadata.emplace_back("x-session-id", asked_.session);
    bridged.message = serialized(request);
    call_ = std::make_shared<BridgedCall>(
        context_, BridgedCall::Receiver{
                      .admitted = [] {},
                      .message = [self = shared_from_this(),
                                  on_message](const grpc::ByteBuffer& message) { (self.get()->*on_message)(message); },
                      .end =
                          [self = shared_from_this(), on_end](const grpc::Status& status) {
                              self->call_.reset();
                              (self.get()->*on_end)(status);
                          },
                  });
    call_->start(means_.channel, std::move(bridged));
}

void LatestMesh::take_part(const grpc::ByteBuffer& message) {
    messages_.push_back(message);
    if (!announced_) {
        const auto first = parsed<v1::WatchResponse>(message);
        announced_ = first.has_mesh_begin();
        instance_ = call_->initial_metadata("x-session-instance");
        if (announced_) early_ = early_answer(first.mesh_begin());
    }
    if (early_)
        call_->cancel();
    else
        call_->read();
}

std::optional<Page> LatestMesh::early_answer(const v1::MeshBegin& mesh) {
    const std::string tag = entity_tag(asked_, instance_, mesh);
    if (!tag.empty() && (if_none_match_ == "*" || if_none_match_.find(tag) != std::string::npos))
        return with_tag({.status = 304}, tag);
    try {
        require_possible_glb(asked_, mesh);
    } catch (const LimitExceeded& refusal) {
        return Page{.status = insufficient_storage, .body = std::string(refusal.what()) + '\n'};
    }
    if (const std::uint64_t bytes = bytes_for_glb(asked_, mesh); !memory_.hold(bytes))
        return Page{.status = 503,
                    .body = fmt::format("there is no memory for a file of this mesh, about {} bytes with its making: "
                                        "try again later, or ask for ?draco\n",
                                        bytes)};
    return std::nullopt;
}

void LatestMesh::end_snapshot(const grpc::Status& status) {
    if (early_) return answer(*std::exchange(early_, {}));
    if (!status.ok()) return answer(page_of(status));
    if (!announced_)
        return answer({.status = 404, .body = fmt::format("session {} has no mesh yet\n", asked_.session)});
    v1::GetSessionRequest request;
    request.set_id(asked_.session);
    call(get_session_method, request, &LatestMesh::take_description, &LatestMesh::end_description);
}

void LatestMesh::take_description(const grpc::ByteBuffer& message) {
    up_ = parsed<v1::GetSessionResponse>(message).session().description().up_axis();
    call_->read();
}

void LatestMesh::end_description(const grpc::Status& status) {
    if (!status.ok()) return answer(page_of(status));
    boost::asio::post(means_.worker, [self = shared_from_this()]() mutable {
        Page page = self->decoded();
        const auto context = self->context_;
        boost::asio::post(
            *context, [self = std::move(self), page = std::move(page)]() mutable { self->answer(std::move(page)); });
    });
}

Page LatestMesh::decoded() const {
    try {
        MeshGlb glb = mesh_glb(asked_, messages_, up_, canceled_);
        return with_tag({.content_type = "model/gltf-binary", .body = std::move(glb.file)},
                        entity_tag(asked_, instance_, glb.mesh));
    } catch (const LimitExceeded& refusal) {
        return {.status = insufficient_storage, .body = std::string(refusal.what()) + '\n'};
    } catch (const std::exception& error) {
        spdlog::error("the mesh of session {} as GLB: internal error: {}", asked_.session, error.what());
        return {.status = 500, .body = "Internal error; the server's log says more.\n"};
    }
}

void LatestMesh::answer(Page page) {
    messages_.clear();
    // From here on the file alone is there, until the client has taken it.
    memory_.hold(page.body.size());
    page.memory = std::make_shared<RetainedMemory>(std::move(memory_));
    std::exchange(answered_, {})(std::move(page));
}

}  // namespace meniscus::server
