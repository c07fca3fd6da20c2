// A build without zlib.
#include "formats/bytes/deflate.hpp"
#include "formats/bytes/inflate.hpp"
#include "meniscus/error.hpp"

namespace meniscus::formats {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw NotBuilt(what, "zlib: build it where zlib1g-dev is installed");
}

}  // namespace

struct Inflater::Stream {};

Inflater::Inflater(const ByteCursor& at, std::string_view /*compressed*/, Deflate /*form*/, std::string_view what)
    : at_(at) {
    at_.fail(std::string(what) +
             " is compressed, which this build does not read: build it where zlib1g-dev is installed");
}

Inflater::~Inflater() = default;

void Inflater::extend(std::string& /*out*/, std::uint64_t /*size*/) {}

std::string inflate(const ByteCursor& at, std::string_view compressed, Deflate form, std::uint64_t /*most*/,
                    std::string_view what) {
    const Inflater refused(at, compressed, form, what);
    return {};
}

std::string deflated(std::string_view /*bytes*/) {
    refuse("a compressed file");
}

std::uint32_t crc32(std::uint32_t /*before*/, std::string_view /*bytes*/) {
    refuse("a zip file (.npz)");
}

}  // namespace meniscus::formats
