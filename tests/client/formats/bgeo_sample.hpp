// A classic BGEO file as Partio writes one.
#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "formats/bytes/scalar.hpp"

namespace meniscus::test {

inline std::string big(std::int32_t value) {
    std::string out;
    formats::store(out, value, std::endian::big);
    return out;
}
inline std::string big(float value) {
    std::string out;
    formats::store(out, value, std::endian::big);
    return out;
}
/// A name or a string after its length.
inline std::string counted(const std::string& text) {
    std::string out;
    formats::store(out, static_cast<std::uint16_t>(text.size()), std::endian::big);
    return out + text;
}
/// type: 0 float, 1 int, 4 index of a string, 5 vector.
inline std::string bgeo_attribute(const std::string& name, std::uint16_t size, std::int32_t type) {
    std::string out = counted(name);
    formats::store(out, size, std::endian::big);
    out += big(type);
    for (int i = 0; i < size; ++i) out += big(std::int32_t{0});
    return out;
}
inline std::string bgeo_header(std::int32_t points, std::int32_t attributes) {
    return "BgeoV" + big(std::int32_t{5}) + big(points) + big(std::int32_t{1}) + big(std::int32_t{0}) +
           big(std::int32_t{0}) + big(attributes) + big(std::int32_t{0}) + big(std::int32_t{0}) + big(std::int32_t{0});
}

/// Two points with a velocity, an id, a material by name, and a primitive behind them.
inline std::string sample_bgeo() {
    std::string out = bgeo_header(2, 4) + bgeo_attribute("Velocity", 3, 5) + bgeo_attribute("id", 1, 1);
    out += counted("material") + std::string{0, 1} + big(std::int32_t{4}) + big(std::int32_t{2}) + counted("water") +
           counted("milk");
    out += bgeo_attribute("uv", 2, 0);
    for (const int i : {0, 1}) {
        const auto x = static_cast<float>(i);
        for (const float value : {1.0F + x, 2.0F + x, 3.0F + x, 1.0F, 10.0F + x, 20.0F + x, 30.0F + x})
            out += big(value);
        out += big(std::int32_t{7 - 9 * i}) + big(std::int32_t{i}) + big(0.5F) + big(0.25F);
    }
    return out + big(std::int32_t{0x8000}) + std::string{'\0', '\xff'};
}

inline std::string gzipped(const std::string& bytes) {
    constexpr int gzip_window = 15 + 16;
    z_stream stream{};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

}  // namespace meniscus::test
