#include "connection/connection.hpp"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "address/default_port.hpp"
#include "address/loopback.hpp"
#include "connection/deadline.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::client {

namespace {

std::string read_pem(const std::string& path) {
    if (path.empty()) return {};
    // Reading one throws what names neither the file nor what is wanted.
    if (std::filesystem::is_directory(path)) throw InvalidInput(path + " is a folder, must be a file in PEM form");
    std::ifstream file(path, std::ios::binary);
    std::string pem{std::istreambuf_iterator<char>(file), {}};
    if (pem.find("-----BEGIN ") == std::string::npos)
        throw InvalidInput(path + " cannot be read, or holds nothing in PEM form");
    return pem;
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const ConnectionOptions& options) {
    if (options.certificate_file.empty() != options.key_file.empty())
        throw InvalidInput("mutual TLS needs a certificate and its key; only one of them is given");
    if (options.ca_file.empty() && !options.certificate_file.empty())
        throw InvalidInput("certificate " + options.certificate_file + " is given without a CA to trust");
    if (options.ca_file.empty()) return grpc::InsecureChannelCredentials();
    return grpc::SslCredentials({.pem_root_certs = read_pem(options.ca_file),
                                 .pem_private_key = read_pem(options.key_file),
                                 .pem_cert_chain = read_pem(options.certificate_file)});
}

std::shared_ptr<grpc::Channel> open_channel(const std::string& address, const ConnectionOptions& options) {
    grpc::ChannelArguments arguments;
    // A server that has just started is found without gRPC's wait of seconds between attempts, and a new connection
    // does not inherit that wait from an old one.
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 500);
    // gRPC's minimum is the time that one attempt may take: several ways to a server that is far away, and back.
    arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5000);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    // A server that answers nothing any more has gone, though no connection was closed. The timeout is TCP's, too, for
    // bytes that are not taken, and a proxy takes none while a busy server takes none of the stream: minutes.
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 60'000);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 240'000);
    arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);  // without a limit: watchers send no data
    if (!options.server_name.empty()) arguments.SetSslTargetNameOverride(options.server_name);
    return grpc::CreateCustomChannel(address, credentials(options), arguments);
}

bool is_web_address(const std::string& address) {
    const std::size_t end = address.find("://");
    if (end == std::string::npos) return false;
    std::string scheme = address.substr(0, end);
    std::ranges::transform(scheme, scheme.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return scheme == "http" || scheme == "https";
}

/// Throws InvalidInput for an address that is none, or that looks like one with a port.
std::string checked_address(const std::string& address) {
    if (address.empty()) throw InvalidInput("the server's address is empty: give HOST, HOST:PORT or unix:PATH");
    if (is_web_address(address))
        throw InvalidInput("the server's address " + quoted(address) +
                           " is one of the web, as its viewer has: give HOST:PORT alone; the server listens at port " +
                           std::string(address::default_port) + " unless it was told otherwise");
    if (address::is_bare_ipv6(address))
        throw InvalidInput("the server's address " + address + " is IPv6 without brackets: write [" + address +
                           "], or [" + address + "]:" + std::string(address::default_port));
    if (address::has_bad_port(address))
        throw InvalidInput("the server's address " + address + " has no port from 1 to 65535 behind its host");
    return address::with_port(address);
}

/// Waits as WaitForStateChange does, which nothing can end: in pieces, where a stop is possible.
bool wait_for_change(grpc::Channel& channel, grpc_connectivity_state from,
                     std::chrono::system_clock::time_point deadline, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds piece{50};
    if (!stop.stop_possible()) return channel.WaitForStateChange(from, deadline);
    while (!stop.stop_requested()) {
        const auto now = std::chrono::system_clock::now();
        if (channel.WaitForStateChange(from, std::min(deadline, now + piece))) return true;
        if (now >= deadline) return false;
    }
    return false;
}

/// Whether the channel is connected before it is time to give up.
bool connect(grpc::Channel& channel, const ConnectionOptions& options) {
    const auto last_retry = deadline_after<std::chrono::system_clock>(options.wait);
    const auto deadline = deadline_after<std::chrono::system_clock>(std::max(options.timeout, options.wait));
    for (;;) {
        const grpc_connectivity_state state = channel.GetState(true);
        if (state == GRPC_CHANNEL_READY) return true;
        const bool refused = state == GRPC_CHANNEL_TRANSIENT_FAILURE;
        if (!wait_for_change(channel, state, refused ? last_retry : deadline, options.stop)) return false;
    }
}

/// gRPC's words, where they tell of the machinery and not of the mistake.
std::string in_plain_words(const std::string& reason) {
    const auto has = [&reason](std::string_view words) { return reason.find(words) != std::string::npos; };
    if (has("http1.x server"))
        return "what listens there speaks HTTP/1, as the port of a viewer or a proxy does: the server itself listens "
               "at port " +
               std::string(address::default_port) + " unless it was told otherwise";
    if (has("C-ares") || has("DNS resolution")) return "its name cannot be resolved to an address";
    return reason;
}

/// Why there is no connection.
std::string connection_failure(v1::ServerService::Stub& server) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(200));
    v1::GetServerInfoResponse response;
    return in_plain_words(server.GetServerInfo(&context, {}, &response).error_message());
}

/// The token, if it may be sent.
std::string checked_token(const std::string& address, const ConnectionOptions& options) {
    for (const char c : options.token)
        if (c <= ' ' || c > '~') throw InvalidInput("the token has a character that is not a visible ASCII one");
    if (!options.token.empty() && options.ca_file.empty() && !options.insecure && !address::is_loopback(address))
        throw InvalidInput("the token would travel to " + address +
                           " without TLS: give the server's CA, or say that this is meant (--tls-ca, --insecure)");
    return options.token;
}

}  // namespace

Connection::Connection(const std::string& server_address, const ConnectionOptions& options)
    : address(checked_address(server_address)),
      timeout(options.timeout),
      channel(open_channel(address, options)),
      server(v1::ServerService::NewStub(channel)),
      sessions(v1::SessionService::NewStub(channel)),
      surfaces(v1::SurfaceService::NewStub(channel)),
      recordings(v1::RecordingService::NewStub(channel)),
      token_(checked_token(address, options)) {
    if (connect(*channel, options)) return;
    if (options.stop.stop_requested())
        throw ServerError("the attempt to connect to " + address + " was canceled", ErrorCode::canceled);
    const std::string reason = connection_failure(*server);
    if (options.ca_file.empty())
        throw ServerError("no server at " + address + " (" + reason +
                              "): start meniscusd, or check the address and whether it wants TLS",
                          ErrorCode::unavailable);
    throw ServerError(
        "no TLS connection to " + address + " (" + reason + "): check the address, the CA and the certificates",
        ErrorCode::unavailable);
}

void Connection::add_metadata(grpc::ClientContext& context, const std::string& session_id) const {
    if (!session_id.empty()) add_session_id(context, session_id);
    if (!token_.empty()) context.AddMetadata("authorization", "Bearer " + token_);
}

std::vector<Codec> Connection::offered_codecs(const std::stop_token& stop) const {
    {
        const std::lock_guard lock(mutex_);
        if (offered_codecs_) return *offered_codecs_;
    }
    grpc::ClientContext context;
    add_metadata(context, {});
    context.set_deadline(deadline_after<std::chrono::system_clock>(timeout));
    const std::stop_callback cancel_on_stop(stop, [&context] { context.TryCancel(); });
    v1::GetServerInfoResponse response;
    if (!server->GetServerInfo(&context, {}, &response).ok()) return {Codec::draco};
    std::vector<Codec> offered;
    for (const int number : response.codecs())
        if (const auto codec = codec_by_number(static_cast<std::uint32_t>(number))) offered.push_back(*codec);
    const std::lock_guard lock(mutex_);
    return offered_codecs_.emplace(std::move(offered));
}

void add_session_id(grpc::ClientContext& context, const std::string& session_id) {
    // gRPC ends the process for metadata that are no text. What else is no UUID the server refuses.
    constexpr std::size_t longest = 4096;  // of all metadata it takes 8192 bytes
    if (session_id.size() > longest)
        throw InvalidInput("the session's id has " + std::to_string(session_id.size()) + " characters, must be a UUID");
    for (const char c : session_id)
        if (c < ' ' || c > '~')
            throw InvalidInput("the session's id has a character that is not an ASCII one to be read, must be a UUID");
    context.AddMetadata("x-session-id", session_id);
}

}  // namespace meniscus::client
