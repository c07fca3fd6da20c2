// The SHA-256 of bytes, which names the files of a publication.
#pragma once

#include <string>
#include <string_view>

namespace meniscus {

/// 64 hexadecimal digits in lower case.
std::string sha256_of(std::string_view bytes);

}  // namespace meniscus
