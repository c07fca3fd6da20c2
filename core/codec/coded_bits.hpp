// The bits of CodingOptions, which hold for all codecs.
#pragma once

namespace meniscus {

/// Throws InvalidInput unless they are 2 to 16, or 0 for no normals.
void check_normal_bits(int normal_bits);

}  // namespace meniscus
