// The command line of meniscus-load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/server_flags.hpp"
#include "cli/options/settings_options.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

struct LoadOptions {
    cli::ServerFlags server;
    unsigned simulators = 1;  ///< each with a session of its own

    // Numbers of watchers of each simulator.
    unsigned watchers = 1;  ///< read as fast as they can
    unsigned slow = 0;      ///< take slow_seconds over each frame
    double slow_seconds = 0.5;
    unsigned stalled = 0;    ///< stop reading
    unsigned vanishing = 0;  ///< break their connection after vanish_after frames, and come again
    std::uint64_t vanish_after = 10;

    double rate = 10.0;     ///< frames per second of each simulator
    double seconds = 10.0;  ///< duration of sending
    double warm_up = 1.0;   ///< seconds at the beginning whose latencies do not count
    client::StreamOptions stream;

    std::size_t particles = 16000;   ///< number of them in a frame of moving water
    std::vector<std::string> files;  ///< particle files in place of moving water, one after the other and over again
    double particle_radius = 0.025;  ///< world units
    cli::SettingsOptions settings;

    std::string json;  ///< file for the results; "-" for standard output; empty for none
};

/// The end of a program that does no work: after --help, --version or a wrong flag.
struct EarlyExit {
    std::string text;
    int code = 0;
};

std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, LoadOptions& options);

}  // namespace meniscus::load
