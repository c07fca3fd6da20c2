// Bytes as base64 text, written piece by piece.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "formats/bytes/atomic_file.hpp"

namespace meniscus::formats {

/// Writes one stream: what write() was given, one after the other, padded by finish(). Takes no memory for it.
class Base64Writer {
public:
    explicit Base64Writer(AtomicFile& out) : out_(out) {}

    void write(std::string_view bytes);
    /// Behind it another stream may begin.
    void finish();

private:
    AtomicFile& out_;
    std::array<char, 3> waiting_{};  ///< bytes that make no whole group of three yet
    std::size_t count_ = 0;          ///< of them, at most 2
};

}  // namespace meniscus::formats
