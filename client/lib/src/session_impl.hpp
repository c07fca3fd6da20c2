// The inside of a Session.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "connection/connection.hpp"
#include "made_sessions.hpp"
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
    const Settings& settings() const noexcept { return settings_; }
    /// The sessions that were made, for streams, which create one again where a server has lost it.
    const std::shared_ptr<MadeSessions>& made() const noexcept { return made_; }
    /// Creates the session again, if it is owned and has ended meanwhile.
    void create_again(const std::stop_token& stop);
    void end(const std::stop_token& stop);
    std::function<void()> ending() const;
    void leave() noexcept { owned_ = false; }

private:
    /// Joins it if it is there.
    v1::CreateSessionResponse create(const std::stop_token& stop);

    const std::shared_ptr<Connection> connection_;
    const std::string id_;
    const Settings settings_;
    const SessionOptions options_;
    const std::shared_ptr<MadeSessions> made_ = std::make_shared<MadeSessions>();
    bool owned_;
};

}  // namespace meniscus::client
