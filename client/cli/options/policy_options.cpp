#include "cli/options/policy_options.hpp"

#include <CLI/CLI.hpp>
#include <limits>

#include "cli/options/named_option.hpp"

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

}  // namespace meniscus::cli
