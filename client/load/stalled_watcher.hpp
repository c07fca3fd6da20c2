// A watcher that stops reading: it opens a call for a session's meshes and reads none.
#pragma once

#include <memory>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::load {

class StalledWatcher {
public:
    /// Returns when the server has accepted the call. Throws ServerError.
    StalledWatcher(const std::string& server, const client::ConnectionOptions& connection, const std::string& session);
    ~StalledWatcher();
    StalledWatcher(const StalledWatcher&) = delete;
    StalledWatcher& operator=(const StalledWatcher&) = delete;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::load
