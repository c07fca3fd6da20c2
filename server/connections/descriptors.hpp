// How many connections the descriptors of this process are enough for.
#pragma once

#include <cstddef>

namespace meniscus::server {

/// Raises the soft limit of descriptors to the hard one. Returns the limit from then on.
std::size_t raise_descriptor_limit();

/// The limit of descriptors of this process.
std::size_t descriptor_limit();

/// What connections of each port may take at a time. All of them together, and what the server itself needs, are fewer
/// than the descriptors, so that a full port leaves the others what they need.
struct ConnectionShares {
    std::size_t grpc = 0;
    std::size_t http = 0;
    std::size_t probes = 0;
};

/// descriptors: the limit. own: descriptors that are not connections' (files, devices). wanted: connections of the gRPC
/// port; 0: all that is left.
ConnectionShares share_descriptors(std::size_t descriptors, std::size_t own, std::size_t wanted);

}  // namespace meniscus::server
