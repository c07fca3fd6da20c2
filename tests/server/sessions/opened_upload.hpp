// An upload to a session without a stream behind it.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "sessions/intake/upload.hpp"
#include "sessions/session/session.hpp"

namespace meniscus::server::test {

/// See Upload and Session::open_upload().
inline std::shared_ptr<Upload> open_upload(
    Session& session, const UploadOptions& options = {},
    std::function<void(std::size_t)> wake = [](std::size_t /*part*/) {}, std::function<void()> drain = [] {},
    std::function<void(std::exception_ptr)> stop = [](const std::exception_ptr&) {}) {
    auto upload = std::make_shared<Upload>(options, std::move(wake), std::move(drain), std::move(stop));
    session.open_upload(upload);
    return upload;
}

}  // namespace meniscus::server::test
