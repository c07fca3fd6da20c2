// A watcher that stops reading: it asks for a session's meshes and takes none.
#pragma once

#include <memory>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::load {

class StalledWatcher {
public:
    /// Returns when the server has accepted it. Throws ServerError.
    StalledWatcher(const std::string& server, const client::ConnectionOptions& connection, const std::string& session);
    ~StalledWatcher();
    StalledWatcher(const StalledWatcher&) = delete;
    StalledWatcher& operator=(const StalledWatcher&) = delete;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::load
