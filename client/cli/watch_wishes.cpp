#include "cli/watch_wishes.hpp"

#include <CLI/CLI.hpp>
#include <chrono>

#include "cli/options/normal_bits.hpp"
#include "cli/options/option_group.hpp"

namespace meniscus::cli {

void WatchWishes::add_to(CLI::App& command) {
    const OptionGroup group(command, "What is sent");
    add_normal_bits(command, options.normal_bits, "")->capture_default_str();
    command
        .add_option(
            "--position-bits", options.position_bits,
            "Vertices lie on multiples of the cell size / 2^BITS, 2 or more; fewer bits take fewer bytes. Default: as "
            "reconstructed")
        ->check(CLI::Range(2, 8));
    command.add_option("--max-level", options.max_level, "Finest level of grid, 1 to 3: a coarser surface, as closed")
        ->check(CLI::Range(1, 3))
        ->capture_default_str();
    command.add_option("--region", region, "X0 Y0 Z0 X1 Y1 Z1: only bricks that touch this box, world units")
        ->expected(6);
    command
        .add_option("--bytes-per-second", options.bytes_per_second,
                    "Bandwidth in the mean, such as 2MB: frames are skipped to keep it; 0: no limit")
        ->transform(CLI::AsSizeValue(false))
        ->capture_default_str();
    command.add_option("--viewpoint", viewpoint, "X Y Z: the nearest bricks are sent first, world units")->expected(3);
    command
        .add_option("--reconnect", reconnect,
                    "Seconds for which a broken connection or a restarting server is tried again; 0: no retries")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
}

client::WatchOptions WatchWishes::build() const {
    client::WatchOptions out = options;
    if (!region.empty()) out.region = Box{{region[0], region[1], region[2]}, {region[3], region[4], region[5]}};
    if (!viewpoint.empty()) out.viewpoint = {viewpoint[0], viewpoint[1], viewpoint[2]};
    out.reconnect = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(reconnect));
    return out;
}

}  // namespace meniscus::cli
