// Frames to publish, from everything that has some.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cli/options/server_flags.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/options/watch_flags.hpp"
#include "cli/sequence/frame_selection.hpp"
#include "formats/bytes/read_limits.hpp"
#include "formats/particles/particle_formats.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "meniscus/client/session_info.hpp"

namespace meniscus::cli {

/// What `meniscus publish` was told.
struct PublishCommand {
    std::string source;
    std::filesystem::path to;               ///< as given: a folder, or the page with single_file
    std::filesystem::path folder;           ///< of the publication
    bool page = false;                      ///< the folder gets the viewer, too
    bool single_file = false;               ///< `to` is one page with everything
    std::optional<double> particle_radius;  ///< of particle files
    std::optional<formats::ParticleFormat> input_format;
    formats::ReadLimits limits;
    SettingsOptions settings;
    BackendOptions backend;
    FrameSelection selection;
    std::uint64_t every = 1;           ///< frames whose number is a multiple of this
    std::optional<double> frame_rate;  ///< frames per second; none: as the source has them
    std::optional<double> keep;        ///< seconds of the newest frames; none: all stay
    WatchFlags form;
    client::SessionDescription description;
    ServerFlags server;
    Verbosity verbosity;

    bool is_wanted(std::uint64_t number) const { return number % every == 0 && selection.is_in_range(number); }
};

/// described: what the source says of itself, where the command says nothing.
client::PublishOptions publish_options(const PublishCommand& command, const client::SessionDescription& described);

/// These publish all frames of the source that are wanted and not yet there. They throw InvalidInput, LimitExceeded,
/// ServerError, or std::runtime_error where writing fails; what was published until then stays.
void publish_particles(const PublishCommand& command);
void publish_bricks(const PublishCommand& command);
void publish_recording(const PublishCommand& command);
/// Until the session ends, or the process is interrupted.
void publish_session(const PublishCommand& command);

}  // namespace meniscus::cli
