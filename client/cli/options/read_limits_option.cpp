#include "cli/options/read_limits_option.hpp"

#include <CLI/CLI.hpp>

#include "cli/options/option_group.hpp"
#include "formats/bytes/read_limits.hpp"

namespace meniscus::cli {

void add_read_limits(CLI::App& command, formats::ReadLimits& limits) {
    const OptionGroup group(command, files_heading);
    command
        .add_option(
            "--max-file-bytes", limits.most_bytes,
            "Refuse an input that takes more bytes, as 4G, with all that it makes grow; by default more than half "
            "of the memory, at most 8G")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("BYTES");
}

}  // namespace meniscus::cli
