// The whole server in one object: sessions, services, and the port.
#pragma once

#include <grpcpp/server.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "connections/descriptors.hpp"
#include "connections/grpc_port.hpp"
#include "connections/port_check.hpp"
#include "meniscus/reconstructor.hpp"
#include "metrics/prometheus_metrics.hpp"
#include "recording/recording_reads.hpp"
#include "recording/recording_writer.hpp"
#include "rpc/health_service.hpp"
#include "rpc/services.hpp"
#include "rpc/standard_services.hpp"
#include "security/access.hpp"
#include "sessions/limits/limits.hpp"
#include "sessions/session_registry.hpp"
#include "web/http_server.hpp"

namespace meniscus::server {

struct ServerOptions {
    std::string listen = "127.0.0.1:50051";  ///< "HOST:PORT", port 0 for a free one, or "unix:PATH"
    TlsFiles tls;                            ///< none: no TLS
    std::string tokens;                      ///< file of tokens; empty: every client may do everything
    bool insecure = false;                   ///< whether other machines may connect without TLS
    std::string http;    ///< "HOST:PORT" for viewer, metrics and probes, port 0 for a free one; empty: none
    std::string probes;  ///< "HOST:PORT" for metrics and probes alone, without TLS; empty: none
    std::vector<std::string> trusted_proxies;  ///< addresses and networks without limits for each peer address
    std::vector<std::string> web_origins;      ///< pages of other machines that may call over the HTTP port
    StandardServices standard_services;
    BackendOptions backend;    ///< backend and threads alone; the rest comes from `limits` and `devices`
    std::vector<int> devices;  ///< the GPUs to use; empty: all that can reconstruct
    Limits limits;
    RecordingOptions recording;
    /// How long shutdown() waits for clients to take their answers.
    std::chrono::milliseconds shutdown_grace = std::chrono::seconds(10);
};

/// The reasons why a server cannot start with these options, one line each. Does not notice an address that is in use
/// or a folder that cannot be written to.
std::vector<std::string> problems_of(const ServerOptions& options);

class Server {
public:
    /// Listens when it returns. Throws InvalidInput if the backend or the address cannot be used, Unavailable if
    /// another program has the address or the folder of recordings, or this machine has no such address.
    explicit Server(const ServerOptions& options);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// In the form that clients use, with the port that was chosen.
    const std::string& address() const noexcept { return port_.address(); }
    /// The address of the HTTP port; empty if there is none.
    std::string http_address() const { return http_ ? http_->address() : std::string(); }
    /// The address of the port for metrics and probes alone; empty if there is none.
    std::string probes_address() const { return probes_ ? probes_->address() : std::string(); }
    const BackendDescription& backend() const noexcept { return backend_; }
    /// None if nothing is recorded.
    const RecordingWriter* recordings() const noexcept { return recordings_.get(); }

    /// Reads certificates and tokens again, for connections and calls from now on. Logs a file that cannot be used, and
    /// keeps what it had before.
    void reload() { access_.reload(); }

    /// Takes no new frames, answers those in flight, ends the watchers. Calls that are left after the grace period are
    /// canceled.
    void shutdown();

private:
    std::vector<prometheus::MetricFamily> metrics();
    void add_observation(Router& router);
    void serve_http(const AllowedOrigins& origins);
    void serve_probes();

    const ServerOptions options_;
    Access access_;
    const BackendDescription backend_;
    const ConnectionShares shares_;
    const Limits limits_;  ///< in force: connections as far as there are descriptors
    const std::shared_ptr<PrometheusMetrics> metrics_;
    const std::unique_ptr<RecordingWriter> recordings_;  ///< none: nothing is recorded
    SessionRegistry registry_;
    const std::unique_ptr<RecordingReads> recording_reads_;  ///< none: nothing is recorded
    ActiveCalls streams_;
    ActiveCalls receivers_;  ///< calls of watchers and readers
    Refusals refusals_;
    HealthService health_service_;
    ServerServiceImpl server_service_;
    SessionServiceImpl session_service_;
    SurfaceServiceImpl surface_service_;
    RecordingServiceImpl recording_service_;
    GrpcPort port_;
    std::unique_ptr<grpc::Server> grpc_;
    std::unique_ptr<PortCheck> check_;
    std::atomic<bool> draining_{false};
    std::unique_ptr<HttpServer> http_;  ///< these last: their pages read the rest
    std::unique_ptr<HttpServer> probes_;
};

}  // namespace meniscus::server
