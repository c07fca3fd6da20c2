#include "pushed_upload.hpp"

#include "../src/frame.hpp"
#include "../src/result.hpp"
#include "../src/timeout.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"
#include "meniscus/frame_order.hpp"
#include "push_answer.hpp"

namespace meniscus::c {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

}  // namespace

PushedUpload::PushedUpload(const meniscus_client& client, const PushArguments& arguments, const std::string& beginning)
    : process_(client.program, arguments.words, arguments.token) {
    process_.write(bytes_of(beginning));
    const JsonLine first = process_.next(std::nullopt).line.value_or(JsonLine());
    const auto id = first.find("session");
    if (id == first.end())
        throw client::ServerError(client.program + " push answers no session: is it of another version?",
                                  client::ErrorCode::unimplemented);
    id_ = id->second;
}

void PushedUpload::require_order(std::uint64_t index, double simulation_time) const {
    require_frame_order(last_index_, index, simulation_time);
}

void PushedUpload::write(std::span<const FramePiece> pieces, std::uint64_t index) {
    for (const FramePiece& piece : pieces) {
        process_.write(bytes_of(piece.head));
        process_.write(piece.data);
    }
    last_index_ = index;
}

meniscus_result PushedUpload::next(double timeout_seconds, meniscus_frame** frame) {
    required(frame, "frame") = nullptr;
    const PushProcess::Answer answer = process_.next(timeout_of(timeout_seconds));
    if (!answer.line) return answer.ended ? MENISCUS_ENDED : MENISCUS_NOTHING_YET;
    *frame = new meniscus_frame{read_answer(*answer.line)};
    return MENISCUS_OK;
}

void not_through_push(const std::string& what, const std::string& remedy) {
    throw NotBuilt(what, "the service, and meniscus push cannot do it: " + remedy);
}

}  // namespace meniscus::c
