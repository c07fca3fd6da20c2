#include "cli/options/server_flags.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "cli/options/not_empty.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/seconds_option.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

std::string from_environment(const char* variable) {
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
}

std::string read_token(const std::string& file) {
    if (!file.empty()) return CLI::detail::trim_copy(formats::read_file(file));
    return from_environment("MENISCUS_TOKEN");
}

}  // namespace

CLI::Option* ServerFlags::add_to(CLI::App& command, const std::string& description) {
    const OptionGroup group(command, server_heading);
    CLI::Option* server = command.add_option("--server", address, description)
                              ->type_name("HOST[:PORT]")
                              ->check(not_empty("HOST, HOST:PORT or unix:PATH"));
    const auto add_file = [&](const std::string& flag, std::string& file, const std::string& meaning) {
        return command.add_option(flag, file, meaning)
            ->type_name("FILE")
            ->check(not_empty("a file's name"))
            ->needs(server);
    };
    CLI::Option* ca =
        add_file("--tls-ca", options.ca_file,
                 "TLS: certificates of the authorities to trust, PEM (default: the variable MENISCUS_SERVER_CA)");
    CLI::Option* certificate =
        add_file("--tls-cert", options.certificate_file, "Mutual TLS: this client's certificate, PEM")->needs(ca);
    certificate->needs(add_file("--tls-key", options.key_file, "Key of that certificate, PEM")->needs(certificate));
    command
        .add_option("--tls-server-name", options.server_name,
                    "Name in the server's certificate, if not the address's host (with MENISCUS_SERVER_CA: "
                    "MENISCUS_SERVER_NAME)")
        ->type_name("NAME")
        ->check(not_empty("the name in the server's certificate"))
        ->needs(ca);
    add_file("--token-file", token_file, "File with the token to call with (default: the variable MENISCUS_TOKEN)");
    command.add_flag("--insecure", options.insecure, "Let the token travel to another machine without TLS")
        ->needs(server);
    add_seconds(command, "--wait", options.wait, "Seconds to wait for a server that is still starting")
        ->check(number_range(0.0, 86400.0))
        ->needs(server);
    return server;
}

client::ConnectionOptions ServerFlags::connection() const {
    client::ConnectionOptions connection = options;
    connection.token = read_token(token_file);
    if (connection.ca_file.empty()) {
        connection.ca_file = from_environment("MENISCUS_SERVER_CA");
        connection.server_name = from_environment("MENISCUS_SERVER_NAME");
    }
    return connection;
}

client::Client ServerFlags::connect() const {
    try {
        return client::Client(address, connection());
    } catch (const client::ServerError& e) {
        throw ServerNotReached(e);
    }
}

}  // namespace meniscus::cli
