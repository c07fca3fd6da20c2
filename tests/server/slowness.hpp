// For limits of time: sanitizers take time themselves.
#pragma once

namespace meniscus::server::test {

/// How many times as long a program may take that is watched by a sanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double slowness = 6.0;
#else
constexpr double slowness = 1.0;
#endif

}  // namespace meniscus::server::test
