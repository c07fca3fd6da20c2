#include "formats/recordings/brick_stream.hpp"

#include <cmath>
#include <utility>

#include "files/brick_file_format.hpp"
#include "files/recording_format.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/v1/brick_file.pb.h"
#include "receiving/frame_receiver.hpp"

namespace meniscus::formats {
namespace {

std::string frame_name(std::uint64_t index) {
    return "frame " + std::to_string(index);
}

}  // namespace

BrickStream::BrickStream(PipedMessages& messages, const ReadLimits& limits)
    : messages_(messages), limits_(limits), receiver_(std::make_unique<client::FrameReceiver>(true)) {
    if (!messages_.follows(files::brick_file_magic))
        messages_.fail("not a file of bricks: its first line is not 'Meniscus bricks'");
    begin_file();
}

BrickStream::~BrickStream() = default;

std::optional<client::ReceivedFrame> BrickStream::next() {
    while (true) {
        message_at_ = messages_.position();
        while (!in_frame_ && messages_.follows(files::brick_file_magic)) begin_file();
        if (!in_frame_ && messages_.follows(files::recording_magic))
            fail("a recording behind bricks: a pipe has particles or finished bricks, and not both");
        const auto next = message();
        if (!next) return std::nullopt;
        if (next->has_mesh_begin()) begin_frame(next->mesh_begin());
        try {
            if (auto frame = receiver_->take(*next)) {
                in_frame_ = false;
                frame->index = *last_frame_;
                messages_.name_place({});
                return frame;
            }
        } catch (const client::ServerError& error) {
            fail(error.what());
        }
    }
}

void BrickStream::begin_file() {
    is_new_file_ = true;
    message_at_ = messages_.position();
    messages_.begins_with(files::brick_file_magic);
    const auto bytes = messages_.next(files::max_recording_entry_bytes);
    if (!bytes) messages_.fail_cut();
    v1::BrickFileBegin begin;
    if (!begin.ParseFromString(*bytes)) fail("no beginning of a file of bricks");
    if (begin.version() != files::brick_file_version)
        fail("bricks of format version " + std::to_string(begin.version()) + "; this program reads version " +
             std::to_string(files::brick_file_version));
}

std::optional<v1::StreamResponse> BrickStream::message() {
    message_at_ = messages_.position();
    const auto bytes = messages_.next(files::max_recorded_message_bytes);
    if (!bytes && in_frame_) messages_.fail_cut();
    if (!bytes) return std::nullopt;
    frame_bytes_ += bytes->size();
    if (in_frame_ && frame_bytes_ > limits_.most_bytes)
        fail(frame_name(*last_frame_) + " has more than " + std::to_string(limits_.most_bytes) +
             " bytes, the most that are read: publish it in several parts, or allow more by --max-file-bytes");
    v1::StreamResponse message;
    if (!message.ParseFromString(*bytes)) fail("no message of a frame of bricks");
    return message;
}

void BrickStream::begin_frame(const v1::MeshBegin& message) {
    if (std::exchange(is_new_file_, false))
        shift_ = last_frame_ && message.frame_index() <= *last_frame_ ? *last_frame_ - message.frame_index() + 1 : 0;
    const std::uint64_t index = message.frame_index() + shift_;
    const std::string name = frame_name(index);
    if (in_frame_) fail(name + " begins before " + frame_name(*last_frame_) + " has ended");
    if (last_frame_ && index <= *last_frame_) fail(name + " after " + frame_name(*last_frame_) + "; indices must rise");
    if (!std::isfinite(message.simulation_time()))
        fail(name + " has simulation time " + std::to_string(message.simulation_time()) + "; it must be finite");
    last_frame_ = index;
    in_frame_ = true;
    frame_bytes_ = 0;
    messages_.name_place(name);
}

void BrickStream::fail(const std::string& what) const {
    messages_.fail("at byte " + std::to_string(message_at_) + ": " + what);
}

}  // namespace meniscus::formats
