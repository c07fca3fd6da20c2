#include "cli/options/policy_options.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <limits>

#include "cli/options/named_option.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/seconds_option.hpp"

namespace meniscus::cli {

CLI::Option* add_policy_options(CLI::App& command, client::StreamOptions& stream) {
    auto* policy = add_named_option(command, "--policy", stream.policy,
                                    "What the server does with frames that come faster than they are reconstructed: "
                                    "every-frame (they wait), latest (newer ones replace them), every-nth (see --nth)");
    command.add_option("--nth", stream.nth, "With --policy every-nth: one of this many frames is reconstructed")
        ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()))
        ->needs(policy)
        ->capture_default_str();
    return policy;
}

void add_stream_options(CLI::App& command, client::StreamOptions& stream, CLI::Option& server) {
    add_policy_options(command, stream)->needs(&server);
    stream.reconnect = std::chrono::seconds(30);
    add_seconds(command, "--reconnect", stream.reconnect,
                "With --server: seconds for which a server that is out of reach is tried again; 0: no retries")
        ->check(number_range(0.0, 1e6))
        ->default_str("30")
        ->needs(&server);
}

}  // namespace meniscus::cli
