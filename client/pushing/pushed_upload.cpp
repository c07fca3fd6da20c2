#include "pushing/pushed_upload.hpp"

#include "meniscus/client/errors.hpp"
#include "meniscus/frame_order.hpp"

namespace meniscus::pushing {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

}  // namespace

PushedUpload::PushedUpload(const std::string& program, const PushArguments& arguments, const std::string& beginning)
    : process_(program, arguments.words, arguments.token) {
    process_.write(bytes_of(beginning));
    const JsonLine first = process_.next(std::nullopt).line.value_or(JsonLine());
    const auto id = first.find("session");
    if (id == first.end())
        throw client::ServerError(program + " push answers no session: is it of another version?",
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

}  // namespace meniscus::pushing
