#include "codec/coded_bits.hpp"

#include <cstdint>
#include <string>

#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

void check_normal_bits(int normal_bits) {
    if (normal_bits != 0 && (normal_bits < 2 || normal_bits > 16))
        throw InvalidInput("normal bits are " + std::to_string(normal_bits) + ", must be 2 to 16, or 0 for no normals");
}

std::uint32_t encoded_offset_bits(const Mesh& mesh, const CodingOptions& options) {
    if (options.position_bits == 0) return mesh.offset_bits;
    if (options.position_bits < static_cast<int>(min_offset_bits) ||
        static_cast<std::uint32_t>(options.position_bits) > mesh.offset_bits)
        throw InvalidInput("position bits are " + std::to_string(options.position_bits) + ", must be " +
                           std::to_string(min_offset_bits) + " to " + std::to_string(mesh.offset_bits) +
                           ", or 0 for all");
    return static_cast<std::uint32_t>(options.position_bits);
}

}  // namespace meniscus
