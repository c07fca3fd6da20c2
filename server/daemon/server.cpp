#include "daemon/server.hpp"

#include <fmt/format.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iterator>
#include <thread>

#include "connections/descriptors.hpp"
#include "connections/grpc_port.hpp"
#include "connections/listen_address.hpp"
#include "connections/port_check.hpp"
#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "metrics/connection_metrics.hpp"
#include "metrics/gauge_family.hpp"
#include "metrics/limit_gauges.hpp"
#include "metrics/process_metrics.hpp"
#include "metrics/prometheus_metrics.hpp"
#include "metrics/publication_metrics.hpp"
#include "metrics/recording_metrics.hpp"
#include "metrics/session_gauges.hpp"
#include "process/open_work.hpp"
#include "publishing/publications.hpp"
#include "recording/recording_reads.hpp"
#include "recording/recording_tidying.hpp"
#include "recording/recording_writer.hpp"
#include "recording/session_recording.hpp"
#include "rpc/services/call_counter.hpp"
#include "rpc/services/health_service.hpp"
#include "rpc/services/known_methods.hpp"
#include "rpc/services/request_guard.hpp"
#include "rpc/services/server_instance.hpp"
#include "rpc/services/services.hpp"
#include "rpc/services/standard_services.hpp"
#include "security/access.hpp"
#include "security/trusted_peers.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/session/session_registry.hpp"
#include "web/frame_ancestors.hpp"
#include "web/http_server.hpp"
#include "web/observation_pages.hpp"
#include "web/published_files.hpp"
#include "web/viewer_pages.hpp"

namespace meniscus::server {

namespace {

/// For clients to take something that they are sent, or to confirm that the connection ends.
constexpr auto goodbye_time = std::chrono::milliseconds(250);

/// The part of the grace period that is kept for canceling the calls of clients that never read, hundreds of them.
std::chrono::milliseconds canceling_time(std::chrono::milliseconds grace) {
    return std::min(2 * goodbye_time, grace / 4);
}

unsigned threads_or_processors(unsigned threads) {
    return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

/// Throws InvalidInput if the backend or a device cannot be used.
BackendDescription describe(const ServerOptions& options) {
    const Backend choice = options.backend.backend;
    if (choice == Backend::cpu) {
        if (!options.devices.empty())
            throw InvalidInput("--devices needs --backend cuda or auto: the CPU was asked for");
        return describe_backend(choice);
    }
    for (const int device : options.devices) describe_backend(Backend::cuda, device);
    std::vector<cuda::Device> usable = cuda::devices(options.devices);
    // With several devices, each is started when a session goes there.
    if (usable.size() == 1 && !cuda::answers(usable.front().index)) usable.clear();
    return describe_backend(choice, usable.empty() ? 0 : usable.front().index);
}

/// Where there was no GPU at the start, none is looked for again.
BackendOptions for_sessions(BackendOptions backend, const BackendDescription& found) {
    if (found.backend == Backend::cpu) backend.backend = Backend::cpu;
    return backend;
}

/// Each may be null: nothing is recorded, nothing published.
Observe observe_with(RecordingWriter* recordings, Publications* publications) {
    return [=](const SessionIdentity& identity, const Settings& settings) {
        if (identity.kind.publish && publications == nullptr)
            throw Refusal(Refusal::Kind::failed_precondition,
                          "this server publishes nothing: start it with --publish, or create the session without "
                          "publish");
        SessionObservers observers;
        if (recordings != nullptr)
            observers.push_back(std::make_shared<SessionRecording>(*recordings, identity.id, settings, identity.owner,
                                                                   identity.kind.description));
        if (identity.kind.publish) observers.push_back(publications->observe(identity, settings));
        return observers;
    };
}

/// A client that vanished without a goodbye is noticed, and its session is free again.
void keep_alive(grpc::ServerBuilder& builder) {
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 20'000);
    // Clients ask every minute; gRPC ends the connection of one that asks more often than this.
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 10'000);
}

// Each throws InvalidInput for an address that is none, and if others could connect there without TLS, or call without
// a token, where that is not meant.

void require_listen(const ServerOptions& options) {
    require_listen_address(options.listen);
    if (!options.insecure && !options.tls.any()) require_loopback("--listen", options.listen);
}

void require_http(const ServerOptions& options) {
    if (options.http.empty()) return;
    parse_host_port("--http", options.http);
    if (!options.insecure && !options.tls.any()) require_loopback("--http", options.http);
}

void require_publishable(const ServerOptions& options) {
    if (options.publishing.enabled && options.http.empty())
        throw InvalidInput("--publish serves files over the HTTP port, which is off: give --http HOST:PORT");
}

void require_tokens_for_all(const ServerOptions& options) {
    if (!options.tokens.empty() && (options.reflection || options.channelz))
        throw InvalidInput(fmt::format("{} cannot be had with --tokens: gRPC answers it without asking for one",
                                       options.reflection ? "--reflection" : "--channelz"));
}

void require_closed_to_others(const ServerOptions& options) {
    require_listen(options);
    require_http(options);
    require_publishable(options);
    require_tokens_for_all(options);
}

/// Bounds the memory and the time that a connection can take in gRPC itself. (keep_alive() is for both ends.)
void bound_connections(grpc::ServerBuilder& builder) {
    // A few bytes would become gigabytes, before the call's token is known.
    builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
    builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
    // More than the shipped proxies pass on: gRPC ends a connection for what is larger, with all of its calls.
    constexpr int metadata_bytes = 64 << 10;
    builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, metadata_bytes);
    constexpr int streams = 1000;
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, streams);
    // A connection that sends nothing keeps its place for this time.
    constexpr int handshake_milliseconds = 20'000;
    builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, handshake_milliseconds);
}

/// Descriptors of the server itself: libraries, devices, recordings.
std::size_t own_descriptors(const ServerOptions& options, const BackendDescription& backend) {
    constexpr std::size_t always = 64;
    constexpr std::size_t devices = 128;
    constexpr std::size_t where_unlimited = 256;
    std::size_t own = always;
    if (backend.backend == Backend::cuda) own += devices;
    if (!options.recording.directory.empty())
        for (const std::size_t files : {options.limits.sessions, options.limits.recording_readers})
            own += files != 0 ? files : where_unlimited;
    return own;
}

/// Publications that are kept of sessions that have ended.
std::size_t most_ended(const Limits& limits) {
    constexpr std::size_t where_unlimited = 256;
    return limits.sessions != 0 ? limits.sessions : where_unlimited;
}

ConnectionShares shares_of(const ServerOptions& options, const BackendDescription& backend) {
    return share_descriptors(descriptor_limit(), own_descriptors(options, backend), options.limits.connections);
}

Limits in_force(Limits limits, const ConnectionShares& shares) {
    limits.connections = static_cast<std::uint32_t>(shares.grpc);
    return limits;
}

}  // namespace

std::vector<std::string> problems_of(const ServerOptions& options) {
    const std::vector<std::function<void()>> steps{
        [&] { require_listen(options); },
        [&] { require_http(options); },
        [&] { require_publishable(options); },
        [&] { require_tokens_for_all(options); },
        [&] { AllowedOrigins(options.web_origins, options.http); },
        [&] { FrameAncestors{options.web_frame_ancestors}; },
        [&] { TrustedPeers{options.trusted_proxies}; },
        [&] {
            if (!options.probes.empty()) parse_host_port("--probes", options.probes);
        },
        [&] {
            if (options.tls.any()) load_certificates(options.tls);
        },
        [&] {
            if (!options.tokens.empty()) Tokens::load(options.tokens);
        },
        [&] { require_recordable(options.recording); },
        [&] { describe(options); },
    };
    std::vector<std::string> problems;
    for (const auto& step : steps) {
        try {
            step();
        } catch (const InvalidInput& error) {
            problems.emplace_back(error.what());
        }
    }
    return problems;
}

class Server::Impl {
public:
    explicit Impl(const ServerOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const std::string& address() const noexcept { return port_.address(); }
    std::string http_address() const { return http_ ? http_->address() : std::string(); }
    std::string probes_address() const { return probes_ ? probes_->address() : std::string(); }
    const BackendDescription& backend() const noexcept { return backend_; }
    const RecordingWriter* recordings() const noexcept { return recordings_.get(); }
    void reload() { access_.reload(); }
    void shutdown();

private:
    std::vector<prometheus::MetricFamily> metrics();
    void add_observation(Router& router);
    std::unique_ptr<HttpServer> open_http(const std::string& listen, const AllowedOrigins& origins);
    void serve_http_if_possible(const AllowedOrigins& origins);
    void serve_probes();

    const ServerOptions options_;
    Access access_;
    const FrameAncestors frame_ancestors_;
    const BackendDescription backend_;
    const ConnectionShares shares_;
    const Limits limits_;  ///< in force: connections as far as there are descriptors
    const std::shared_ptr<PrometheusMetrics> metrics_;
    const std::unique_ptr<RecordingWriter> recordings_;  ///< none: nothing is recorded
    const std::unique_ptr<Publications> publications_;   ///< none: nothing is published
    SessionRegistry registry_;
    const std::unique_ptr<RecordingReads> recording_reads_;  ///< none: nothing is recorded
    const std::unique_ptr<RecordingTidying> tidying_;        ///< none: nothing is recorded
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

Server::Impl::Impl(const ServerOptions& options)
    : options_((require_closed_to_others(options), options)),
      access_(options.tls, options.tokens, options.trusted_proxies),
      frame_ancestors_(options.web_frame_ancestors),
      backend_(describe(options)),
      shares_(shares_of(options, backend_)),
      limits_(in_force(options.limits, shares_)),
      metrics_(std::make_shared<PrometheusMetrics>()),
      recordings_(options.recording.directory.empty() ? nullptr : std::make_unique<RecordingWriter>(options.recording)),
      publications_(options.publishing.enabled ? std::make_unique<Publications>(options.publishing, most_ended(limits_))
                                               : nullptr),
      registry_(limits_, for_sessions(options.backend, backend_), threads_or_processors(options.backend.threads),
                options.devices, metrics_, observe_with(recordings_.get(), publications_.get())),
      recording_reads_(recordings_ ? std::make_unique<RecordingReads>(options.recording.directory,
                                                                      options.limits.recording_readers,
                                                                      options.limits.reader_patience)
                                   : nullptr),
      tidying_(recording_reads_ ? std::make_unique<RecordingTidying>(*recording_reads_, options.recording.retention)
                                : nullptr),
      refusals_(metrics_),
      server_service_(access_.authorizer(), refusals_, backend_, threads_or_processors(options.backend.threads),
                      limits_, publications_ != nullptr),
      session_service_(registry_, publications_.get(), access_.authorizer(), refusals_),
      surface_service_(registry_, access_.authorizer(), refusals_, streams_, receivers_),
      recording_service_(recording_reads_.get(), access_.authorizer(), refusals_, *metrics_, receivers_),
      port_(options.listen, {.all = shares_.grpc, .for_each_peer = options.limits.connections_per_peer},
            TrustedPeers(options.trusted_proxies)) {
    const AllowedOrigins origins(options.web_origins, options.http);
    load_standard_services();
    grpc::ServerBuilder builder;
    bound_connections(builder);
    builder.SetMaxReceiveMessageSize(static_cast<int>(options.limits.message_bytes));
    keep_alive(builder);
    auto connections = builder.experimental().AddExternalConnectionAcceptor(
        grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD, access_.credentials());
    builder.RegisterService(&health_service_);
    builder.RegisterService(&server_service_);
    builder.RegisterService(&session_service_);
    builder.RegisterService(&surface_service_);
    builder.RegisterService(&recording_service_);
    add_standard_services(builder, {.reflection = options.reflection, .channelz = options.channelz});
    std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
    interceptors.push_back(make_call_counter(metrics_));
    interceptors.push_back(make_instance_marker());
    interceptors.push_back(make_request_guard(
        [this](const std::string& peer) { return port_.received_bytes().of(peer); }, options.limits.message_bytes));
    builder.experimental().SetInterceptorCreators(std::move(interceptors));
    grpc_ = builder.BuildAndStart();
    if (!grpc_) throw InvalidInput(fmt::format("gRPC cannot serve {}", options.listen));
    health_service_.set_serving(true);
    port_.start(std::move(connections));
    check_ = std::make_unique<PortCheck>(port_.sockets(),
                                         options.tls.any() ? PortCheck::Protocol::tls : PortCheck::Protocol::http2,
                                         port_.own_connections());
    if (options.http_is_default)
        serve_http_if_possible(origins);
    else if (!options.http.empty())
        http_ = open_http(options.http, origins);
    if (!options.probes.empty()) serve_probes();
    spdlog::info("connections: {} to the gRPC port, {} to the HTTP port, of {} descriptors", shares_.grpc, shares_.http,
                 descriptor_limit());
}

Server::Impl::~Impl() {
    shutdown();
}

void Server::Impl::shutdown() {
    if (!grpc_) return;
    const auto time = options_.shutdown_grace - canceling_time(options_.shutdown_grace);
    const auto deadline = std::chrono::system_clock::now() + time;
    draining_ = true;
    health_service_.set_serving(false);
    // Then there is time left to say what the disk was too slow for.
    if (recordings_) recordings_->finish_by(std::chrono::steady_clock::now() + time);
    registry_.drain(time);
    if (recording_reads_) recording_reads_->end();
    // Before the shutdown, so that its goodbye follows the last answer on each connection: gRPC closes a connection
    // once the client has confirmed the goodbye, or loses what the client has not read. Idle clients confirm late or
    // never.
    {
        const OpenWork::Entry working(open_work(), "the answers to streams");
        streams_.wait_until_none(deadline);
    }
    // The frames are done. A client that only receives, and may have stopped reading long ago, holds nobody up.
    const auto at_most = [&](std::chrono::milliseconds wait) {
        return std::min(deadline, std::chrono::system_clock::now() + wait);
    };
    const OpenWork::Entry working(open_work(), "the connections of its clients");
    receivers_.wait_while_they_progress(deadline, goodbye_time);
    // First: its calls go to the server in this process, and what they ended with is still to be taken.
    if (http_) http_->finish(at_most(goodbye_time));
    http_.reset();
    check_->stop();
    port_.stop();
    grpc_->Shutdown(at_most(goodbye_time));
    grpc_.reset();
    // The thread of an alarm, or of a session, may still hold a call that is over, for a moment, and the session with
    // it.
    streams_.wait_until_none();
    receivers_.wait_until_none();
    probes_.reset();
}

/// Serves HTTP at the default address, which nobody has asked for: if it is taken, at another port, or not at all.
void Server::Impl::serve_http_if_possible(const AllowedOrigins& origins) {
    if (options_.http.empty()) return;
    const std::string free_port = options_.http.substr(0, options_.http.rfind(':')) + ":0";
    try {
        try {
            http_ = open_http(options_.http, origins);
        } catch (const AddressUnavailable& taken) {
            http_ = open_http(free_port, origins);
            spdlog::info("{}: the viewer has another port (--http chooses one; --http off: none)", taken.what());
        }
    } catch (const std::exception& error) {
        spdlog::warn("there is no viewer: {} (--http chooses an address; --http off: none)", error.what());
    }
}

std::unique_ptr<HttpServer> Server::Impl::open_http(const std::string& listen, const AllowedOrigins& origins) {
    const std::shared_ptr<const TlsContext> tls = access_.http_tls();
    Router router;
    add_viewer_pages(router, frame_ancestors_);
    add_observation(router);
    const GrpcWeb calls{
        .channel = grpc_->InProcessChannel({}),
        .origins = origins,
        .needs_certificate = tls && tls->mutual(),
        .memory = registry_.memory(),
        .published = std::make_shared<PublishedFiles>(publications_.get(), access_.authorizer(), tls && tls->mutual()),
        .refused = [metrics = metrics_](std::string_view target, grpc::StatusCode code) {
            const Metrics::Method& method = known_method(target);
            metrics->call_started(method);
            metrics->call_ended(method, metric_name_of(code), 0.0);
        }};
    HttpLimits limits;
    limits.connections = shares_.http;
    limits.streams = shares_.http * 3 / 4;
    limits.connections_per_peer = std::min<std::size_t>(options_.limits.connections_per_peer, shares_.http / 4);
    return std::make_unique<HttpServer>(listen, std::move(router), calls, limits, tls,
                                        TrustedPeers(options_.trusted_proxies));
}

void Server::Impl::serve_probes() {
    Router router;
    add_observation(router);
    HttpLimits limits;
    limits.connections = shares_.probes;
    limits.streams = 0;
    probes_ = std::make_unique<HttpServer>(options_.probes, std::move(router), GrpcWeb{}, limits);
}

std::vector<prometheus::MetricFamily> Server::Impl::metrics() {
    std::vector<prometheus::MetricFamily> all = metrics_->collect();
    const auto add = [&all](std::vector<prometheus::MetricFamily> more) {
        all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    };
    all.push_back(gauge("meniscus_ready", "1; 0 once it shuts down, while the frames in flight are finished.",
                        draining_ ? 0 : 1));
    add(connection_metrics(port_.counts()));
    add(session_gauges(registry_));
    add(limit_gauges(limits_, backend_));
    const Access::Expiry expiry = access_.expiry();
    all.push_back(gauges("meniscus_certificate_expires_timestamp_seconds",
                         "When the first certificate of the file in use expires, seconds since 1970; +Inf: there is "
                         "none.",
                         "file", {{"tls_cert", expiry.server}, {"tls_client_ca", expiry.client_ca}}));
    if (recordings_) add(recording_metrics(recordings_->counters(), recording_reads_->readers()));
    if (publications_) add(publication_metrics(publications_->counters(), publications_->count()));
    add(process_metrics());
    return all;
}

void Server::Impl::add_observation(Router& router) {
    add_observation_pages(
        router, [this] { return metrics(); }, [this] { return check_->answers(); }, [this] { return !draining_; });
}

Server::Server(const ServerOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Server::~Server() = default;

const std::string& Server::address() const noexcept {
    return impl_->address();
}

std::string Server::http_address() const {
    return impl_->http_address();
}

std::string Server::probes_address() const {
    return impl_->probes_address();
}

const BackendDescription& Server::backend() const noexcept {
    return impl_->backend();
}

const RecordingWriter* Server::recordings() const noexcept {
    return impl_->recordings();
}

void Server::reload() {
    impl_->reload();
}

void Server::shutdown() {
    impl_->shutdown();
}

}  // namespace meniscus::server
