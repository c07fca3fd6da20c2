// A message that is larger than any that is taken.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <vector>

namespace meniscus::server::test {

/// Zeros, all of them the bytes of one mebibyte: a large message costs its sender no memory.
inline grpc::ByteBuffer mebibytes_of_zeros(std::size_t count) {
    static const std::vector<char> bytes(std::size_t{1} << 20U, '\0');
    const std::vector<grpc::Slice> slices(count, grpc::Slice(bytes.data(), bytes.size(), grpc::Slice::STATIC_SLICE));
    return {slices.data(), slices.size()};
}

}  // namespace meniscus::server::test
