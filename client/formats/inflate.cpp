#include "formats/inflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace meniscus::formats {
namespace {

constexpr std::size_t piece_bytes = std::size_t{256} << 10;
constexpr int window_bits = 15;
constexpr int gzip_header = 16;  // added to the window's bits

int window_of(Deflate form) {
    switch (form) {
        case Deflate::raw:
            return -window_bits;
        case Deflate::zlib:
            return window_bits;
        case Deflate::gzip:
            return window_bits + gzip_header;
    }
    return window_bits;
}

}  // namespace

std::string inflate(const ByteCursor& at, std::string_view compressed, Deflate form, std::uint64_t most,
                    std::string_view what) {
    const std::string name(what);
    z_stream stream{};
    if (inflateInit2(&stream, window_of(form)) != Z_OK) at.fail(name + " cannot be decompressed: no memory");
    const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, &inflateEnd);
    std::string out;
    for (int status = Z_OK; status != Z_STREAM_END;) {
        if (stream.avail_in == 0) {
            if (compressed.empty()) at.fail(name + " ends before its compressed data do");
            const std::size_t size = std::min<std::size_t>(compressed.size(), std::numeric_limits<uInt>::max());
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
            stream.avail_in = static_cast<uInt>(size);
            compressed.remove_prefix(size);
        }
        const std::size_t before = out.size();
        // One byte more than is allowed shows that there is more.
        const std::size_t room = static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, most - before + 1));
        out.resize(before + room);
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
        stream.avail_out = static_cast<uInt>(room);
        status = ::inflate(&stream, Z_NO_FLUSH);
        out.resize(before + room - stream.avail_out);
        if (out.size() > most)
            at.fail(name + " has more than the " + std::to_string(most) + " bytes that it may have decompressed");
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            at.fail(name + " has damaged compressed data (" + (stream.msg != nullptr ? stream.msg : "zlib") + ")");
    }
    return out;
}

}  // namespace meniscus::formats
