// The flags that name a server and say how to connect to it.
#pragma once

#include <string>

#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// There is no server where the flags say.
class ServerNotReached : public InvalidInput {
public:
    explicit ServerNotReached(const client::ServerError& error) : InvalidInput(error.what()), code_(error.code()) {}
    client::ErrorCode code() const noexcept { return code_; }

private:
    client::ErrorCode code_;
};

/// --server, --tls-ca, --tls-cert, --tls-key, --tls-server-name, --token-file, --insecure and --wait.
struct ServerFlags {
    std::string address;  ///< "HOST", "HOST:PORT" or "unix:PATH"; empty for none
    client::ConnectionOptions options;
    std::string token_file;

    /// Returns --server, so that the command can say which flags exclude or require it.
    CLI::Option* add_to(CLI::App& command, const std::string& description);
    /// Flags that are not given are taken from MENISCUS_TOKEN, MENISCUS_SERVER_CA and MENISCUS_SERVER_NAME. Throws
    /// InvalidInput for a file that cannot be read.
    client::ConnectionOptions connection() const;
    /// A client over that connection. Throws ServerNotReached if there is no server.
    client::Client connect() const;
};

}  // namespace meniscus::cli
