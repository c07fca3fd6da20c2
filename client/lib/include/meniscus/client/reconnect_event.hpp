// The reports of a stream or a watcher while its connection is broken.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace meniscus::client {

/// One attempt to go on after a connection broke.
struct ReconnectEvent {
    unsigned attempt = 0;  ///< since the connection broke, from 1
    /// Whether this attempt has succeeded; otherwise it begins now.
    bool connected = false;
    std::string reason = {};              ///< why the connection broke, or why the attempt before was in vain
    std::chrono::milliseconds left = {};  ///< until it is given up
};

/// The library goes on when it returns, and takes no notice of what it throws. It may call cancel(), and nothing else
/// of the stream or watcher.
using ReconnectHandler = std::function<void(const ReconnectEvent&)>;

}  // namespace meniscus::client
