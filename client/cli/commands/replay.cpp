// meniscus replay: the particles of a recording, uploaded again.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/print/listener.hpp"
#include "cli/print/statistics_text.hpp"
#include "cli/print/warnings.hpp"
#include "cli/sequence/recording_files.hpp"
#include "cli/sequence/replay_pace.hpp"
#include "cli/surfaces/opened_session.hpp"
#include "cli/surfaces/stream_answers.hpp"

namespace meniscus::cli {
namespace {

/// Frames under way: enough to keep the server busy.
constexpr std::size_t frames_ahead = 4;

struct ReplayOptions {
    RecordingSelection recording;
    ServerFlags server;
    SessionFlags session;
    std::string speed = "1";
    bool loop = false;
    bool strict = false;
    Verbosity verbosity;
};

void upload(const formats::Recording& recording, const ReplayOptions& options, client::Stream& stream,
            Warnings& warnings) {
    const auto frames = recording.frames(options.recording.from, options.recording.to);
    const formats::RecordedFrame& first = frames.front();
    const formats::RecordedFrame& last = frames.back();
    const std::chrono::duration<double> seconds = last.arrived_at - first.arrived_at;
    // Between the last frame and the first of the next round: as between any two.
    const auto interval = frames.size() > 1 ? seconds / static_cast<double>(frames.size() - 1) : seconds;
    ReplayPace pace(options.speed);
    StreamAnswers answers(stream, [&](const client::ReceivedFrame& frame) {
        const std::string name = "frame " + std::to_string(frame.index);
        if (!options.verbosity.quiet) std::cerr << name << ": " << summary(frame.statistics) << '\n';
        warnings.say(name, frame.statistics.warnings);
    });
    for (std::uint64_t round = 0; round == 0 || options.loop; ++round)
        for (const formats::RecordedFrame& frame : frames) {
            if (!options.verbosity.quiet) require_listener();
            const formats::RecordedParticles particles = recording.particles(frame);
            pace.wait((frame.arrived_at - first.arrived_at) + static_cast<double>(round) * (seconds + interval));
            ParticleFrame view = particles.view();
            const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
            view.arrays = arrays;
            stream.push(view, frame.index + round * (last.index - first.index + 1), frame.simulation_time);
        }
    answers.finish();
}

void replay(const ReplayOptions& options) {
    const formats::Recording recording = options.recording.open();
    OpenedSession session(options.server, options.session.over(recording.description()), recording.settings());
    if (!options.verbosity.quiet) std::cerr << "session " << session.id() << '\n';
    Warnings warnings(options.strict);
    client::Stream stream = session.stream({.receive_meshes = false, .waiting_limit = frames_ahead});
    upload(recording, options, stream, warnings);
    session.end();
    warnings.finish();
}

}  // namespace

void add_replay(CLI::App& app) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App& command = *app.add_subcommand("replay", "Upload the particles of a recording again, as a new session");
    options->recording.add_to(command);
    {
        const OptionGroup group(command, "Pace");
        command.add_option("--speed", options->speed, "Times as fast as it was recorded, or max")
            ->capture_default_str();
        command.add_flag("--loop", options->loop,
                         "Begin again after the last frame, until interrupted; frame indices keep rising");
    }
    CLI::Option* server = options->server.add_to(command, "Where to")->required();
    options->session.add_to(command, *server);
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    options->verbosity.add_quiet_to(command);
    add_examples(command, {"meniscus replay recordings/SESSION/000001.recording --server localhost",
                           "meniscus replay recordings/SESSION --server localhost --speed max --from 20 --to 39"});
    command.callback([options] { replay(*options); });
}

}  // namespace meniscus::cli
