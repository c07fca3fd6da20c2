// What a function returns that needs the service, in a build without it.
#pragma once

#include "../src/result.hpp"
#include "meniscus/error.hpp"
#include "meniscus/meniscus.h"

namespace meniscus::c {

inline meniscus_result absent(const char* function) {
    return guarded([function]() -> meniscus_result {
        throw NotBuilt(function, "the service: build it without -DMENISCUS_SERVICE=OFF, where gRPC is installed");
    });
}

/// Of a function that would give an object.
template <class Object>
meniscus_result absent(const char* function, Object** object) {
    if (object != nullptr) *object = nullptr;
    return absent(function);
}

}  // namespace meniscus::c
