#include "cli/options/policy_options.hpp"

#include <CLI/CLI.hpp>
#include <limits>
#include <map>

namespace meniscus::cli {

CLI::Option* add_policy_options(CLI::App& command, client::StreamOptions& stream) {
    static const std::map<std::string, client::UploadPolicy> policies{
        {"every-frame", client::UploadPolicy::every_frame},
        {"latest", client::UploadPolicy::latest},
        {"every-nth", client::UploadPolicy::every_nth}};
    auto* policy = command
                       .add_option("--policy", stream.policy,
                                   "What the server does with frames that come faster than they are reconstructed: "
                                   "every-frame (they wait), latest (newer ones replace them), every-nth (see --nth)")
                       ->transform(CLI::CheckedTransformer(policies).description(""))
                       ->type_name("NAME")
                       ->default_str("every-frame");
    command.add_option("--nth", stream.nth, "With --policy every-nth: of so many frames one is reconstructed")
        ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()))
        ->needs(policy)
        ->capture_default_str();
    return policy;
}

}  // namespace meniscus::cli
