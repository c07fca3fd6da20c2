#include "cli/options/verbosity.hpp"

#include "cli/options/option_group.hpp"

namespace meniscus::cli {

void Verbosity::add_to(CLI::App& command) {
    add_quiet_to(command);
    const OptionGroup group(command, other_heading);
    command.add_flag("-v,--verbose", verbose, "Say what each step took, too")->excludes(command.get_option("--quiet"));
}

void Verbosity::add_quiet_to(CLI::App& command) {
    const OptionGroup group(command, other_heading);
    command.add_flag("-q,--quiet", quiet, "Say nothing but warnings and errors");
}

}  // namespace meniscus::cli
