// meniscus push: frames of particles from a pipe to a server, for programs that do not speak gRPC.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/policy_options.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/print/answer_lines.hpp"
#include "cli/print/listener.hpp"
#include "cli/print/statistics_text.hpp"
#include "cli/print/warnings.hpp"
#include "cli/surfaces/opened_session.hpp"
#include "cli/surfaces/stream_answers.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/recordings/recording_stream.hpp"
#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

struct PushOptions {
    std::string input;
    formats::ReadLimits limits;
    std::optional<double> particle_radius;  ///< none: the settings are the recording's
    SettingsOptions settings;
    ServerFlags server;
    SessionFlags session;
    client::StreamOptions stream;
    std::string answers;
    bool strict = false;
    Verbosity verbosity;
};

/// Those of the flags, or else of the recording.
Settings settings_of(const PushOptions& options, const formats::RecordingStream& frames) {
    if (options.particle_radius) return options.settings.build(*options.particle_radius);
    if (options.settings.any_given())
        throw InvalidInput("the settings are those of the recording, or of the flags: give --particle-radius, too");
    if (frames.settings()) return *frames.settings();
    throw InvalidInput(formats::input_name(options.input) +
                       ": its beginning has no settings: give --particle-radius, and others as needed");
}

void upload(formats::RecordingStream& frames, client::Stream& stream) {
    formats::RecordedParticles particles;
    while (const auto frame = frames.next(particles)) {
        ParticleFrame view = particles.view();
        const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
        view.arrays = arrays;
        stream.push(view, frame->index, frame->simulation_time);
    }
}

void push(const PushOptions& options, AnswerLines& lines) {
    formats::RecordingStream frames(options.input, options.limits);
    const Settings settings = settings_of(options, frames);
    OpenedSession session(options.server, options.session.over(frames.description()), settings);
    if (!options.verbosity.quiet) std::cerr << "session " << session.id() << '\n';
    lines.session(session.id());
    Warnings warnings(options.strict);
    client::StreamOptions stream_options = options.stream;
    stream_options.receive_meshes = false;
    client::Stream stream = session.stream(stream_options);
    const auto answer = [&](const client::ReceivedFrame& frame) {
        const std::string name = "frame " + std::to_string(frame.index);
        if (!options.verbosity.quiet) std::cerr << name << ": " << summary(frame.statistics) << '\n';
        if (options.verbosity.verbose) std::cerr << stages_text(frame.statistics);
        warnings.say(name, frame.statistics.warnings);
        lines.frame(frame, stream.dropped());
        if (!options.verbosity.quiet) require_listener();
    };
    // A stream that has failed needs no more frames, for which the pipe may keep this process waiting.
    StreamAnswers answers(stream, answer, [&frames] { frames.stop(); });
    std::exception_ptr broken_input;
    try {
        upload(frames, stream);
    } catch (...) {
        broken_input = std::current_exception();
    }
    answers.finish();
    if (stream.dropped() != 0) std::cerr << stream.dropped() << " frames dropped, as the policy says\n";
    session.end();
    if (broken_input) std::rethrow_exception(broken_input);
    lines.end(stream.dropped());
    warnings.finish();
}

/// As the last line.
void tell(AnswerLines& lines, const std::exception& error, client::ErrorCode code) {
    try {
        lines.error(error, code);
    } catch (const std::exception&) {
        // Nobody reads the answers: the error is said on stderr all the same.
    }
}

void push_and_tell(const PushOptions& options) {
    AnswerLines lines(options.answers);
    try {
        push(options, lines);
    } catch (const Warned&) {
        throw;
    } catch (const ServerNotReached& error) {
        tell(lines, error, error.code());
        throw;
    } catch (const std::exception& error) {
        tell(lines, error, client::code_of(error));
        throw;
    }
}

}  // namespace

void add_push(CLI::App& app) {
    auto options = std::make_shared<PushOptions>();
    CLI::App& command =
        *app.add_subcommand("push", "Stream frames of particles from a pipe to a server, as a program writes them");
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option("RECORDING", options->input,
                        "- for standard input, a named pipe or a file: a recording, whose meshes are passed over")
            ->required();
        command
            .add_option("--answers", options->answers,
                        "Write a line of JSON for each answer as it comes: the session, the figures of each frame, an "
                        "error; - for standard output")
            ->type_name("FILE");
    }
    add_read_limits(command, options->limits);
    {
        const OptionGroup group(command, surface_heading);
        command.add_option("-r,--particle-radius", options->particle_radius,
                           "World units (default: all settings are those of the recording)");
    }
    options->settings.add_to(command);
    options->settings.add_attribute_to(command);
    CLI::Option* server = options->server.add_to(command, "Where to")->required();
    options->session.add_to(command, *server);
    {
        const OptionGroup group(command, place_heading);
        add_stream_options(command, options->stream, *server);
    }
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    options->verbosity.add_to(command);
    add_examples(command,
                 {"simulation | meniscus push - --server localhost --particle-radius 0.025",
                  "meniscus push recordings/SESSION/000001.recording --server localhost --answers answers.jsonl"});
    command.callback([options] { push_and_tell(*options); });
}

}  // namespace meniscus::cli
