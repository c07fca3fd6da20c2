#include "upload_call.hpp"

#include <google/protobuf/io/coded_stream.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "call_end.hpp"

namespace meniscus::client {

namespace {

using google::protobuf::io::CodedOutputStream;

// What follows serves both calls.
static_assert(int{v1::PublishRequest::kFrameChunkFieldNumber} == int{v1::StreamRequest::kFrameChunkFieldNumber});
static_assert(int{v1::PublishRequest::kFrameEndFieldNumber} == int{v1::StreamRequest::kFrameEndFieldNumber});
static_assert(int{v1::PublishRequest::kMoveFieldNumber} == int{v1::StreamRequest::kMoveFieldNumber});
static_assert(int{v1::PublishRequest::kFinishFieldNumber} == int{v1::StreamRequest::kFinishFieldNumber});
static_assert(int{v1::PublishResponse::kFrameStatisticsFieldNumber} ==
              int{v1::StreamResponse::kFrameStatisticsFieldNumber});
static_assert(int{v1::PublishResponse::kDrainingFieldNumber} == int{v1::StreamResponse::kDrainingFieldNumber});
static_assert(int{v1::PublishResponse::kFrameDroppedFieldNumber} == int{v1::StreamResponse::kFrameDroppedFieldNumber});

/// The largest that the server takes.
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

/// gRPC's generated code has no stub that sends bytes as they are, and its generic stub is asynchronous: this is what
/// its stubs consist of, from a namespace whose names another version of gRPC may change (here: 1.51). The compiler
/// would notice, and so would the tests of streams.
std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, v1::StreamResponse>> start(Connection& connection,
                                                                                      const char* path,
                                                                                      grpc::ClientContext& context) {
    const grpc::internal::RpcMethod method(path, grpc::internal::RpcMethod::BIDI_STREAMING, connection.channel);
    return std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, v1::StreamResponse>>(
        grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, v1::StreamResponse>::Create(
            connection.channel.get(), method, &context));
}

std::uint8_t* write_length(int field, std::size_t length, std::uint8_t* at) {
    constexpr std::uint32_t length_delimited = 2;  // wire type
    at = CodedOutputStream::WriteTagToArray(static_cast<std::uint32_t>(field) << 3U | length_delimited, at);
    return CodedOutputStream::WriteVarint32ToArray(static_cast<std::uint32_t>(length), at);
}

/// A StreamRequest with a FrameChunk whose data is not copied but referred to, and kept alive by `memory`. By hand,
/// since protobuf copies what it serializes: at a frame's size that is the largest cost of sending it.
grpc::ByteBuffer chunk_message(const std::shared_ptr<const void>& memory, std::span<const std::byte> data) {
    std::array<std::uint8_t, 12> data_head{};
    const auto data_head_size = static_cast<std::size_t>(
        write_length(v1::FrameChunk::kDataFieldNumber, data.size(), data_head.data()) - data_head.data());
    std::array<std::uint8_t, 24> head{};
    std::uint8_t* end =
        write_length(v1::StreamRequest::kFrameChunkFieldNumber, data_head_size + data.size(), head.data());
    end = std::copy_n(data_head.data(), data_head_size, end);
    auto reference = std::make_unique<std::shared_ptr<const void>>(memory);
    const std::array<grpc::Slice, 2> slices{
        grpc::Slice(head.data(), static_cast<std::size_t>(end - head.data())),
        // gRPC does not write to it.
        grpc::Slice(
            const_cast<std::byte*>(data.data()), data.size(),
            [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); }, reference.release())};
    return {slices.data(), slices.size()};
}

}  // namespace

UploadCall::UploadCall(std::shared_ptr<Connection> connection, const std::string& session_id,
                       const UploadOpening& opening, bool again)
    : connection_(std::move(connection)), sends_parts_(opening.sends_parts) {
    connection_->add_metadata(context_, session_id);
    call_ = start(*connection_, opening.method, context_);
    // A refusal arrives as the call's status.
    send(again ? opening.request_again : opening.request, {});
}

bool UploadCall::send(const PushedFrame& frame) {
    if (!send(frame.begin, grpc::WriteOptions().set_buffer_hint())) return false;
    for (std::span<const std::byte> part : frame.parts)
        for (; !part.empty(); part = part.subspan(std::min(chunk_bytes, part.size())))
            if (!call_->Write(chunk_message(frame.memory, part.first(std::min(chunk_bytes, part.size())))))
                return false;
    v1::StreamRequest request;
    request.mutable_frame_end();
    return send(request.SerializeAsString(), {});
}

bool UploadCall::send(const std::string& request, grpc::WriteOptions options) {
    const grpc::Slice slice(request);
    return call_->Write(grpc::ByteBuffer(&slice, 1), options);
}

void UploadCall::no_more_frames() {
    if (sends_parts_) {
        v1::StreamRequest request;
        request.mutable_finish();
        send(request.SerializeAsString(), {});
    }
    call_->WritesDone();
}

void UploadCall::move() {
    v1::StreamRequest request;
    request.mutable_move();
    send(request.SerializeAsString(), {});
}

std::string UploadCall::accepted_by() {
    call_->WaitForInitialMetadata();
    return client::accepted_by(context_);
}

bool UploadCall::read(v1::StreamResponse& response) {
    return call_->Read(&response);
}

grpc::Status UploadCall::finish() {
    return call_->Finish();
}

void UploadCall::cancel() {
    context_.TryCancel();
}

}  // namespace meniscus::client
