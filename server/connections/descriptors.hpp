// How many connections the descriptors of this process are enough for.
#pragma once

#include <sys/types.h>

#include <cstddef>

namespace meniscus::server {

/// Raises the soft limit of descriptors to the hard one. Returns the limit from then on.
std::size_t raise_descriptor_limit();

/// The limit of descriptors of this process.
std::size_t descriptor_limit();

/// The file of a descriptor, by which it is known again; 0: there is no such descriptor.
ino_t inode_of(int descriptor);

/// The most connections of each port at a time. All of them together, with the server's own descriptors, are fewer than
/// the process's descriptors, so that a full port leaves room for the others.
struct ConnectionShares {
    std::size_t grpc = 0;
    std::size_t http = 0;
    std::size_t probes = 0;
};

/// descriptors: the limit. own: descriptors that are not connections' (files, devices). wanted: connections of the gRPC
/// port; 0: all that is left.
ConnectionShares share_descriptors(std::size_t descriptors, std::size_t own, std::size_t wanted);

}  // namespace meniscus::server
