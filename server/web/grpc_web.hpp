// The calls that browsers may make, from allowed pages: those without side effects. And the files of publications.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/status.h>

#include <functional>
#include <memory>
#include <string_view>

#include "meniscus/memory.hpp"
#include "web/origins.hpp"
#include "web/published_files.hpp"

namespace meniscus::server {

struct GrpcWeb {
    std::shared_ptr<grpc::Channel> channel;  ///< to the server in this process; none: nothing can be called
    AllowedOrigins origins;
    bool needs_certificate = false;                     ///< a client's, by TLS
    std::shared_ptr<SharedMemory> memory{};             ///< that meshes are made in; none: is not counted
    std::shared_ptr<const PublishedFiles> published{};  ///< none: no such files
    /// Called for a call that ends here, before its handler, with the request's target: so that metrics count it.
    std::function<void(std::string_view target, grpc::StatusCode)> refused{};

    /// target: as in the request line.
    bool serves(std::string_view target) const;
};

/// Whether the target is a method of the contract, served to browsers or not.
bool is_method(std::string_view target);

/// Whether the target is served to browsers and its answer is a stream.
bool is_stream(std::string_view target);

}  // namespace meniscus::server
