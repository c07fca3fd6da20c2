// A session that its owner holds, and that ends with it.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "meniscus/client/particle_watcher.hpp"
#include "meniscus/client/publisher.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/client/stream.hpp"
#include "meniscus/client/watcher.hpp"

namespace meniscus::client {

/// How to open a session that ends with its owner.
struct OpenOptions {
    SessionDescription description = {};
    std::string id = {};  ///< a UUID; empty: a new one
    /// Whether the server ends the session soon after its stream, so that a killed process leaves nothing behind.
    /// False: a session that rests, or is watched between two streams, stays until the Session goes.
    bool ephemeral = true;
    /// Whether a stream is about to be opened to it, see SessionOptions; matters where it is not ephemeral.
    bool stream_follows = false;
    /// Whether the server publishes the session as plain files, see SessionOptions.
    bool publish = false;
    std::stop_token stop{};  ///< when a stop is requested while the session is opened: ServerError (canceled)

    template <class Visit>
    static void rows(const Visit& visit) {
        using O = OpenOptions;
        visit("id", &O::id, {.help = "UUID of the session to create, or to join if it is there", .option = "session"});
        visit("description", &O::description, {.help = "what people call the session, and how viewers show it"});
        visit("ephemeral", &O::ephemeral, {.help = "whether the server ends the session soon after its stream"});
        visit("publish", &O::publish, {.help = "whether the server publishes the session as plain files"});
    }
};

/// A session on the server, from Client::open_session(). When it goes, it ends the session if it has created it, itself
/// or by its streams; a session that was there before stays, and so does one that somebody else has created under its
/// id since it ended. Its streams and watchers may go before it or after it, as may the Client; those that go after it
/// see the session end. Belongs to one thread at a time.
class Session {
public:
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;  ///< ends the session that was held before
    ~Session();  ///< as end(), but throws nothing and returns within a second, even where the server is gone

    const std::string& id() const noexcept;
    /// Whether this session ends with this object: it was created by it, and neither left nor ended.
    bool is_owned() const noexcept;

    /// Throws ServerError, here and below; of a session that has ended: not_found. stop: as in the calls of Client.
    SessionInfo info(const std::stop_token& stop = {});
    /// Opens a stream as Client::stream() does. An owned ephemeral session that has ended meanwhile, since no stream
    /// was open, is created again.
    Stream stream(const StreamOptions& options = {});
    /// Opens a publisher as Client::publish() does, and creates the session again as stream() does.
    Publisher publish(const PublisherOptions& options = {});
    /// Open watchers as Client's functions do.
    Watcher watch(const WatchOptions& options = {});
    ParticleWatcher watch_particles(const ParticleWatchOptions& options = {});

    /// Ends the session now, its streams and watchers with it, if it is owned. Says what went wrong, which the
    /// destructor cannot; a session that is not there any more is no error.
    void end(const std::stop_token& stop = {});
    /// A function that ends the session as end() does, from any thread, also while this object goes and after it: for a
    /// process that is asked to end. It does nothing for a session that is not owned at that time.
    std::function<void()> ending() const;
    /// The session stays when this goes; an ephemeral one still ends soon after its stream.
    void leave() noexcept;

private:
    friend class Client;
    class Impl;
    explicit Session(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
