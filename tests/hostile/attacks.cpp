#include "attacks.hpp"

namespace meniscus::hostile {

std::span<const Attack> attacks() {
    static constexpr Attack all[] = {
        {"gzip-bomb", "512 MiB of zeros, compressed by gzip, without a token", gzip_bomb},
    };
    return all;
}

}  // namespace meniscus::hostile
