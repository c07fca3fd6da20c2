#include "cli/options/part_options.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>

namespace meniscus::cli {

void add_part_options(CLI::App& command, client::StreamOptions& stream, CLI::Option& server, CLI::Option* session) {
    auto* run = command
                    .add_option("--run", stream.run,
                                "With --parts: a number that the processes of all parts share, and no others, such as "
                                "one drawn at random for them")
                    ->check(CLI::Range(std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()));
    auto* parts = command
                      .add_option("--parts", stream.parts,
                                  std::string("With --server") + (session != nullptr ? ", --session" : "") +
                                      " and --run: processes that each upload a part of every frame")
                      ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()))
                      ->needs(&server)
                      ->needs(run)
                      ->capture_default_str();
    if (session != nullptr) parts->needs(session);
    run->needs(parts);
    command.add_option("--part", stream.part, "With --parts: the number of this one, counted from 0; meshes come to 0")
        ->needs(parts)
        ->capture_default_str();
}

}  // namespace meniscus::cli
