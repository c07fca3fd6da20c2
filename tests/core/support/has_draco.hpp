// Whether this build has Draco.
#pragma once

#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"

namespace meniscus::test {

inline bool has_draco() {
    try {
        (void)decode_brick(EncodedBrick{}, min_offset_bits);
    } catch (const NotBuilt&) {
        return false;
    } catch (const InvalidInput&) {
    }
    return true;
}

}  // namespace meniscus::test
