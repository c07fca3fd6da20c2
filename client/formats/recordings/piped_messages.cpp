#include "formats/recordings/piped_messages.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

namespace meniscus::formats {

bool PipedMessages::follows(std::string_view magic) {
    while (true) {
        const std::string_view bytes = ahead();
        if (!bytes.starts_with(magic.substr(0, bytes.size()))) return false;
        if (bytes.size() >= magic.size()) return true;
        std::memmove(buffer_.data(), bytes.data(), bytes.size());
        end_ = bytes.size();
        first_ = 0;
        const std::size_t more = in_.read(std::span(buffer_).subspan(end_));
        if (more == 0) return false;
        end_ += more;
    }
}

bool PipedMessages::begins_with(std::string_view magic) {
    for (std::size_t i = 0; i < magic.size(); ++i) {
        const std::string_view bytes = ahead();
        if (bytes.empty() || bytes.front() != magic[i]) return false;
        take(1);
    }
    return true;
}

void PipedMessages::begin_frame(std::uint64_t bytes, std::string where, bool with_checksum) {
    frame_left_ = bytes;
    where_ = std::move(where);
    checksum_.reset();
    if (with_checksum) checksum_.emplace();
}

void PipedMessages::skip_frame() {
    while (*frame_left_ != 0) {
        const std::string_view bytes = ahead();
        if (bytes.empty()) fail_cut();
        take(static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), *frame_left_)));
    }
}

std::optional<std::uint64_t> PipedMessages::end_frame() {
    frame_left_.reset();
    where_.clear();
    if (!checksum_) return std::nullopt;
    return std::exchange(checksum_, std::nullopt)->value();
}

std::optional<std::string> PipedMessages::next(std::size_t limit) {
    constexpr unsigned longest_varint = 5;  // of lengths up to 2^35: the limits are far below
    const std::uint64_t at = position_;
    std::uint64_t size = 0;
    bool more = true;
    for (unsigned used = 0; more; ++used) {
        if (used == longest_varint) fail("no message at byte " + std::to_string(at));
        if (frame_left_ == 0) return std::nullopt;
        const std::string_view bytes = ahead();
        if (bytes.empty()) {
            if (used == 0 && !frame_left_) return std::nullopt;
            fail_cut();
        }
        const auto digit = static_cast<unsigned char>(bytes.front());
        take(1);
        size |= std::uint64_t{digit & 0x7fU} << (7 * used);
        more = digit >= 0x80U;
    }
    if (size > limit)
        fail("a message of " + std::to_string(size) + " bytes at byte " + std::to_string(at) + "; at most " +
             std::to_string(limit) + " are expected there");
    if (frame_left_ && size > *frame_left_) return std::nullopt;
    std::string message;
    append(size, message);
    return message;
}

std::string_view PipedMessages::ahead() {
    if (first_ == end_) {
        first_ = 0;
        end_ = in_.read(buffer_);
    }
    return {buffer_.data() + first_, end_ - first_};
}

void PipedMessages::take(std::size_t bytes) {
    if (checksum_) checksum_->add({buffer_.data() + first_, bytes});
    first_ += bytes;
    position_ += bytes;
    if (frame_left_) *frame_left_ -= bytes;
}

void PipedMessages::append(std::uint64_t bytes, std::string& out) {
    while (bytes != 0) {
        const std::string_view there = ahead();
        if (there.empty()) fail_cut();
        const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, there.size()));
        out.append(there.substr(0, part));
        take(part);
        bytes -= part;
    }
}

void PipedMessages::fail_cut() const {
    fail("it ends at byte " + std::to_string(position_) + ", within " + (where_.empty() ? "an entry" : where_) +
         ": whatever writes it ended early");
}

}  // namespace meniscus::formats
