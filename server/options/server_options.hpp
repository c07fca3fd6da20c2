// All that a server is given when it starts.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "meniscus/described.hpp"
#include "publishing/publishing_options.hpp"
#include "recording/recording_options.hpp"
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
    bool reflection = false;                       ///< whether clients may read the contract, by gRPC's own service
    bool channelz = false;     ///< whether clients may read the connections and their traffic, by gRPC's own service
    BackendOptions backend;    ///< backend and threads alone; the rest comes from `limits` and `devices`
    std::vector<int> devices;  ///< the GPUs to use; empty: all that can reconstruct
    Limits limits;
    RecordingOptions recording;
    PublishingOptions publishing;
    /// How long shutdown() waits for clients to take their answers.
    std::chrono::milliseconds shutdown_grace = std::chrono::seconds(10);

    /// Calls visit(name, value, facts) for each member that has a flag, in the order of --help; see Limits::rows for
    /// those of limits.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        visit("listen", self.listen,
              {.help = "HOST:PORT (port 0: a free one, which is logged) or unix:PATH (for this user alone)",
               .argument = "HOST:PORT | unix:PATH"});
        TlsFiles::rows(self.tls, visit);
        visit(
            "tokens", self.tokens,
            {.help =
                 "Lines ROLE NAME TOKEN, the role being uploader, publisher, watcher or admin: calls need one of these "
                 "tokens",
             .argument = "FILE"});
        visit("insecure", self.insecure, {.help = "Let other machines connect without TLS, also to --http"});
        visit("http", self.http,
              {.help = "HOST:PORT (port 0: a free one, which is logged) of the viewer, /metrics, /healthz and "
                       "/readyz; off: none. Default: where --listen is TCP on loopback, its port 9464, or a free one "
                       "where that is taken; otherwise off",
               .argument = "HOST:PORT"});
        visit("probes", self.probes,
              {.help = "HOST:PORT of /metrics, /healthz and /readyz alone, always without TLS, also for other "
                       "machines: they tell numbers only",
               .argument = "HOST:PORT"});
        visit("trusted_proxies", self.trusted_proxies,
              {.help = "Addresses and networks, as 192.0.2.7,10.0.0.0/8, of proxies through which others come: limits "
                       "for each peer address do not hold for them, nor for loopback and Unix sockets",
               .argument = "LIST"});
        visit("web_origin", self.web_origins,
              {.help = "Page, as https://example.org, that may call over the HTTP port; those of this machine may",
               .argument = "ORIGIN"});
        visit("web_frame_ancestors", self.web_frame_ancestors,
              {.help = "Pages, as https://example.org,https://example.org:8443, that may show the viewer in a frame",
               .argument = "ORIGINS"});
        visit("reflection", self.reflection, {.help = "Let clients ask for the contract, as grpcurl does"});
        visit("channelz", self.channelz, {.help = "Let clients ask for connections and their traffic"});
        visit("backend", self.backend.backend, {.subject = "backend", .argument = "NAME"});
        visit("devices", self.devices,
              {.help = "GPUs to use, as 0,1: each session on the one with the most free memory. Default: all that can "
                       "be used",
               .argument = "LIST"});
        visit("threads", self.backend.threads,
              {.help = "Worker threads; 0: one per processor", .range = {.most = max_threads}, .argument = "N"});
        Limits::rows(self.limits, visit);
        visit("check_published", self.limits.check_published,
              {.help = "Refuse surfaces that were made elsewhere (Publish) unless they are closed"});
        visit("shutdown_grace", self.shutdown_grace,
              {.help = "Seconds that clients get after SIGTERM to take the frames they are owed",
               .unit = "s",
               .range = {.most = 3600.0},
               .argument = "SECONDS"});
        RecordingOptions::rows(self.recording, visit);
        PublishingOptions::rows(self.publishing, visit);
    }
};

/// The reasons why a server cannot start with these options, one line each. Does not notice an address that is in use
/// or a folder that cannot be written to.
std::vector<std::string> problems_of(const ServerOptions& options);

}  // namespace meniscus::server
