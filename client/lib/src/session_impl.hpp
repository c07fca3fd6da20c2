// The inside of a Session.
#pragma once

#include <memory>
#include <string>

#include "connection/connection.hpp"
#include "meniscus/client/session.hpp"

namespace meniscus::client {

class Session::Impl {
public:
    Impl(std::shared_ptr<Connection> connection, const Settings& settings, const OpenOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const std::shared_ptr<Connection>& connection() const noexcept { return connection_; }
    const std::string& id() const noexcept { return id_; }
    bool is_owned() const noexcept { return owned_; }
    /// If it is owned, and has ended meanwhile.
    void create_again();
    void end();
    void leave() noexcept { owned_ = false; }

private:
    const std::shared_ptr<Connection> connection_;
    const std::string id_;
    const Settings settings_;
    const SessionOptions options_;
    bool owned_;
};

}  // namespace meniscus::client
