// Surfaces reconstructed by a server: one session, one stream.
#pragma once

#include <atomic>
#include <exception>
#include <thread>

#include "cli/surfaces/opened_session.hpp"
#include "cli/surfaces/surfaces.hpp"

namespace meniscus::cli {

class ServerSurfaces : public Surfaces {
public:
    /// Throws InvalidInput if the server is not there or refuses the session.
    ServerSurfaces(const ServerFlags& server, const SessionFlags& session, const Settings& settings,
                   client::StreamOptions options, Handler handler);
    ~ServerSurfaces() override;
    void submit(const ParticleFrame& frame, double simulation_time) override;
    void finish() override;
    std::string session() const override { return session_.id(); }

private:
    void receive();
    void end_stream();

    OpenedSession session_;
    Handler handler_;
    std::optional<client::Stream> stream_;
    std::thread receiver_;
    std::exception_ptr error_;  ///< of the receiver; read after `failed_`
    std::atomic<bool> failed_ = false;
    std::uint64_t frames_ = 0;
};

}  // namespace meniscus::cli
