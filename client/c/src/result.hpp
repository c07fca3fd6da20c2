// The results that C functions return in place of C++ exceptions.
#pragma once

#include <exception>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/meniscus.h"

namespace meniscus::c {

/// Keeps the message for this thread. Called in a handler.
meniscus_result failed() noexcept;

/// The body of every exported function that can fail: returns what `body` does, or the error that it throws.
template <class Body>
meniscus_result guarded(Body&& body) noexcept {
    try {
        return std::forward<Body>(body)();
    } catch (...) {
        return failed();
    }
}

/// name: of the parameter. Throws InvalidInput for NULL.
template <class T>
T& required(T* pointer, const char* name) {
    if (pointer == nullptr) throw InvalidInput(std::string(name) + " is NULL, must point to something");
    return *pointer;
}

}  // namespace meniscus::c
