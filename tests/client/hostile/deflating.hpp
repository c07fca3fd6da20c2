// Compressed bytes, made piece by piece, so that a test that makes a bomb stays small itself.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace meniscus::test {

class Deflating {
public:
    static constexpr int raw = -15;  ///< as in zip files
    static constexpr int gzip = 15 + 16;
    explicit Deflating(int window) { deflateInit2(&z_, Z_BEST_SPEED, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY); }
    ~Deflating() { deflateEnd(&z_); }
    Deflating(const Deflating&) = delete;
    Deflating& operator=(const Deflating&) = delete;

    void add(std::string_view bytes) {
        crc_ = static_cast<std::uint32_t>(crc32_z(crc_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
        z_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        z_.avail_in = static_cast<uInt>(bytes.size());
        run(Z_NO_FLUSH);
    }
    /// The piece as often as it takes for `size` bytes.
    void repeat(std::string_view piece, std::uint64_t size) {
        for (; size > 0; size -= std::min<std::uint64_t>(size, piece.size())) add(piece.substr(0, size));
    }
    void zeros(std::uint64_t size) { repeat(std::string(std::size_t{1} << 16U, '\0'), size); }
    const std::string& finish() {
        run(Z_FINISH);
        return out_;
    }
    std::uint64_t size() const { return z_.total_in; }
    std::uint32_t crc() const { return crc_; }

private:
    void run(int flush) {
        std::string piece(std::size_t{1} << 16U, '\0');
        do {
            z_.next_out = reinterpret_cast<Bytef*>(piece.data());
            z_.avail_out = static_cast<uInt>(piece.size());
            deflate(&z_, flush);
            out_.append(piece, 0, piece.size() - z_.avail_out);
        } while (z_.avail_out == 0);
    }

    z_stream z_{};
    std::uint32_t crc_ = 0;
    std::string out_;
};

}  // namespace meniscus::test
