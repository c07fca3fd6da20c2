// How fast bytes go through a plain socket of this machine: what an upload is compared with.
#pragma once

#include <cstddef>

namespace meniscus::benchmarks {

enum class Transport { tcp, unix_socket };

/// Bytes per second from one thread to another, in pieces of 1 MiB.
double socket_bytes_per_second(Transport transport, std::size_t bytes);

}  // namespace meniscus::benchmarks
