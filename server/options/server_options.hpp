// All that a server is told when it starts.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "recording/recording_options.hpp"
#include "rpc/standard_services.hpp"
#include "security/certificates.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

struct ServerOptions {
    std::string listen = "127.0.0.1:50051";  ///< "HOST:PORT", port 0 for a free one, or "unix:PATH"
    TlsFiles tls;                            ///< none: no TLS
    std::string tokens;                      ///< file of tokens; empty: every client may do everything
    bool insecure = false;                   ///< whether other machines may connect without TLS
    std::string http;  ///< "HOST:PORT" for viewer, metrics and probes, port 0 for a free one; empty: none
    /// Whether nobody has asked for that one: where it cannot be had, another port will do, or none.
    bool http_is_default = false;
    std::string probes;                        ///< "HOST:PORT" for metrics and probes alone, without TLS; empty: none
    std::vector<std::string> trusted_proxies;  ///< addresses and networks without limits for each peer address
    std::vector<std::string> web_origins;      ///< pages of other machines that may call over the HTTP port
    std::vector<std::string> web_frame_ancestors;  ///< pages that may show the viewer in a frame; empty: none
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

}  // namespace meniscus::server
