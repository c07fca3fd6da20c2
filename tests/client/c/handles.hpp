// Handles of the C interface that end with their scope, for tests.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "meniscus/meniscus.h"

namespace meniscus::test {

/// Owns what a C function gives.
template <class Handle, void (*destroy)(Handle*)>
class Owned {
public:
    Owned() = default;
    ~Owned() { destroy(handle_); }
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }

    /// For the function that gives it; what was held before ends.
    Handle** out() {
        destroy(std::exchange(handle_, nullptr));
        return &handle_;
    }
    Handle* get() const { return handle_; }

private:
    Handle* handle_ = nullptr;
};

using COptions = Owned<meniscus_options, meniscus_options_destroy>;
using CReconstructor = Owned<meniscus_reconstructor, meniscus_reconstructor_destroy>;
using CMesh = Owned<meniscus_mesh, meniscus_mesh_destroy>;
using CClient = Owned<meniscus_client, meniscus_client_destroy>;
using CSession = Owned<meniscus_session, meniscus_session_destroy>;
using CPublisher = Owned<meniscus_publisher, meniscus_publisher_destroy>;
using CWatcher = Owned<meniscus_watcher, meniscus_watcher_destroy>;
using CFrame = Owned<meniscus_frame, meniscus_frame_destroy>;

inline COptions options_of(std::initializer_list<std::pair<const char*, const char*>> values) {
    COptions options;
    EXPECT_EQ(meniscus_options_create(options.out()), MENISCUS_OK);
    for (const auto& [name, value] : values) EXPECT_EQ(meniscus_options_set(options.get(), name, value), MENISCUS_OK);
    return options;
}

inline CMesh empty_mesh() {
    CMesh mesh;
    EXPECT_EQ(meniscus_mesh_create(mesh.out()), MENISCUS_OK);
    return mesh;
}

inline std::string sha256(const CMesh& mesh) {
    char digits[MENISCUS_SHA256_SIZE];
    EXPECT_EQ(meniscus_mesh_sha256(mesh.get(), digits), MENISCUS_OK) << meniscus_error_message();
    return digits;
}

/// Whether a call was refused with these words in its message.
inline testing::AssertionResult refused(meniscus_result result, meniscus_result expected, const std::string& words) {
    if (result != expected)
        return testing::AssertionFailure() << meniscus_result_name(result) << ": " << meniscus_error_message();
    if (std::string(meniscus_error_message()).find(words) == std::string::npos)
        return testing::AssertionFailure() << "the message is: " << meniscus_error_message();
    return testing::AssertionSuccess();
}

}  // namespace meniscus::test
