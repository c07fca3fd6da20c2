#include "formats/bytes/inflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>

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

struct Inflater::Stream {
    z_stream z{};
    ~Stream() { inflateEnd(&z); }
};

Inflater::Inflater(const ByteCursor& at, std::string_view compressed, Deflate form, std::string_view what)
    : at_(at), compressed_(compressed), what_(what), stream_(std::make_unique<Stream>()) {
    if (inflateInit2(&stream_->z, window_of(form)) != Z_OK) at_.fail(what_ + " cannot be decompressed: no memory");
}

Inflater::~Inflater() = default;

void Inflater::extend(std::string& out, std::uint64_t size) {
    z_stream& z = stream_->z;
    while (!at_end_ && out.size() < size) {
        if (z.avail_in == 0 && !compressed_.empty()) {
            const std::size_t next = std::min<std::size_t>(compressed_.size(), std::numeric_limits<uInt>::max());
            z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed_.data()));
            z.avail_in = static_cast<uInt>(next);
            compressed_.remove_prefix(next);
        }
        const std::size_t before = out.size();
        const auto room = static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, size - before));
        out.resize(before + room);
        z.next_out = reinterpret_cast<Bytef*>(out.data() + before);
        z.avail_out = static_cast<uInt>(room);
        const int status = ::inflate(&z, Z_NO_FLUSH);
        out.resize(before + room - z.avail_out);
        at_end_ = status == Z_STREAM_END;
        // No progress, though there is room. Not before: zlib holds back bits, of which some kilobytes may still come.
        if (status == Z_BUF_ERROR) at_.fail("truncated: " + what_ + " ends before its compressed data do");
        if (status != Z_OK && status != Z_STREAM_END)
            at_.fail(what_ + " has damaged compressed data (" + (z.msg != nullptr ? z.msg : "zlib") + ")");
    }
}

std::string inflate(const ByteCursor& at, std::string_view compressed, Deflate form, std::uint64_t most,
                    std::string_view what) {
    Inflater inflater(at, compressed, form, what);
    std::string out;
    // One byte more than is allowed shows that there is more.
    inflater.extend(out, most + 1);
    if (out.size() > most)
        at.fail(std::string(what) + " has more than the " + std::to_string(most) +
                " bytes that it may have decompressed");
    return out;
}

}  // namespace meniscus::formats
