// Particle bytes straight from the wire, without a message object between them and their place.
#pragma once

#include <google/protobuf/io/zero_copy_stream.h>

#include <cstddef>
#include <optional>
#include <span>

namespace meniscus::server {

/// Reads a StreamRequest that holds one FrameChunk with its bytes and nothing else, as every protobuf library writes
/// it. Whatever differs from that by a byte - another message, unknown or repeated fields, lengths that do not match,
/// longer varints than needed - is left to protobuf's parser, which alone decides what it means. By hand, since the
/// parser would copy the bytes into a string before they are copied to their place.
class FrameChunkReader {
public:
    /// message: borrowed, at its beginning. message_bytes: its size.
    FrameChunkReader(google::protobuf::io::ZeroCopyInputStream& message, std::size_t message_bytes);

    /// The size of the particle data; none if the message is another one.
    std::optional<std::size_t> bytes() const noexcept { return bytes_; }
    /// Takes the next bytes, or passes over them: bytes() in all.
    void copy_to(std::span<std::byte> place);
    void skip(std::size_t bytes);

private:
    bool next_block();
    std::optional<std::byte> next_byte();
    /// None unless it is in its shortest form and has at most 32 bits.
    std::optional<std::size_t> next_varint();
    /// Whether the next field has this tag and takes all that is left.
    bool enter_last_field(std::byte tag);

    google::protobuf::io::ZeroCopyInputStream& message_;
    std::size_t left_;                  ///< of the message
    std::span<const std::byte> block_;  ///< what is left of the current one
    std::optional<std::size_t> bytes_;
};

}  // namespace meniscus::server
