#include "cli/options/read_limits_option.hpp"

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options/option_group.hpp"
#include "formats/bytes/read_limits.hpp"

namespace meniscus::cli {

void add_read_limits(CLI::App& command, formats::ReadLimits& limits) {
    const OptionGroup group(command, files_heading);
    command
        .add_option("--max-file-bytes", limits.most_bytes,
                    "Refuse an input of more bytes, as 4G, also once it is decompressed")
        ->transform(CLI::AsSizeValue(false))
        ->default_str(std::to_string(limits.most_bytes >> 30) + "G")
        ->type_name("BYTES");
}

}  // namespace meniscus::cli
