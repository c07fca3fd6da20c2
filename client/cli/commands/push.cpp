// meniscus push: frames of particles or of finished bricks from a pipe to a server, for programs that do not speak
// gRPC.
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
#include "cli/options/part_options.hpp"
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
#include "files/brick_file_format.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/recordings/brick_stream.hpp"
#include "formats/recordings/input_pipe.hpp"
#include "formats/recordings/piped_messages.hpp"
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

/// Those of the flags, or else of the recording. recorded: none of bricks, which have no settings.
Settings settings_of(const PushOptions& options, const std::optional<Settings>& recorded) {
    if (options.particle_radius) return options.settings.build(*options.particle_radius);
    if (options.settings.any_given())
        throw InvalidInput("the settings are those of the recording, or of the flags: give --particle-radius, too");
    if (recorded) return *recorded;
    throw InvalidInput(formats::input_name(options.input) +
                       ": its beginning has no settings: give --particle-radius, and others as needed");
}

OpenedSession opened(const PushOptions& options, const SessionFlags& session, const Settings& settings) {
    return {options.server, session, settings, options.stream.parts > 1};
}

/// The options that streams of particles have in common with publishers.
client::PublisherOptions publisher_options(const client::StreamOptions& stream) {
    return {.policy = stream.policy,
            .nth = stream.nth,
            .parts = stream.parts,
            .part = stream.part,
            .run = stream.run,
            .reconnect = stream.reconnect};
}

/// send: pushes all that comes.
template <class Upload, class Send>
void exchange(const PushOptions& options, formats::InputPipe& pipe, OpenedSession& session, Upload upload,
              AnswerLines& lines, const Send& send) {
    Warnings warnings(options.strict);
    const auto answer = [&](const client::ReceivedFrame& frame) {
        const std::string name = "frame " + std::to_string(frame.index);
        if (!options.verbosity.quiet) std::cerr << name << ": " << summary(frame.statistics) << '\n';
        if (options.verbosity.verbose) std::cerr << stages_text(frame.statistics);
        warnings.say(name, frame.statistics.warnings);
        lines.frame(frame, upload.dropped());
        if (!options.verbosity.quiet) require_listener();
    };
    // An upload that has failed needs no more frames, for which the pipe may keep this process waiting.
    StreamAnswers answers(upload, answer, [&pipe] { pipe.stop(); });
    std::exception_ptr broken_input;
    try {
        send(upload);
    } catch (...) {
        broken_input = std::current_exception();
    }
    answers.finish();
    if (upload.dropped() != 0) std::cerr << upload.dropped() << " frames dropped, as the policy says\n";
    session.end();
    if (broken_input) std::rethrow_exception(broken_input);
    lines.end(upload.dropped());
    warnings.finish();
}

void tell_session(const PushOptions& options, const OpenedSession& session, AnswerLines& lines) {
    if (!options.verbosity.quiet) std::cerr << "session " << session.id() << '\n';
    lines.session(session.id());
}

void push_particles(const PushOptions& options, formats::InputPipe& pipe, formats::PipedMessages& messages,
                    AnswerLines& lines) {
    formats::RecordingStream frames(messages, options.limits);
    OpenedSession session =
        opened(options, options.session.over(frames.description()), settings_of(options, frames.settings()));
    tell_session(options, session, lines);
    client::StreamOptions stream = options.stream;
    stream.receive_meshes = false;
    exchange(options, pipe, session, session.stream(stream), lines, [&frames](client::Stream& upload) {
        formats::RecordedParticles particles;
        while (const auto frame = frames.next(particles)) {
            ParticleFrame view = particles.view();
            const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
            view.arrays = arrays;
            upload.push(view, frame->index, frame->simulation_time);
        }
    });
}

void push_bricks(const PushOptions& options, formats::InputPipe& pipe, formats::PipedMessages& messages,
                 AnswerLines& lines) {
    formats::BrickStream frames(messages, options.limits);
    OpenedSession session = opened(options, options.session, settings_of(options, std::nullopt));
    tell_session(options, session, lines);
    exchange(options, pipe, session, session.publish(publisher_options(options.stream)), lines,
             [&frames](client::Publisher& upload) {
                 while (const auto frame = frames.next()) upload.push(*frame);
             });
}

void push(const PushOptions& options, AnswerLines& lines) {
    formats::InputPipe pipe(options.input);
    formats::PipedMessages messages(pipe);
    if (messages.follows(files::brick_file_magic))
        push_bricks(options, pipe, messages, lines);
    else
        push_particles(options, pipe, messages, lines);
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
    CLI::App& command = *app.add_subcommand(
        "push", "Stream frames of particles or bricks from a pipe to a server, as a program writes them");
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option(
                "FRAMES", options->input,
                "- for standard input, a named pipe or a file: a recording, whose meshes are passed over, or files "
                "of finished bricks (.bricks), one behind the other")
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
                           "World units (default: all settings are those of the recording; bricks have none)");
    }
    options->settings.add_to(command);
    options->settings.add_attribute_to(command);
    CLI::Option* server = options->server.add_to(command, "Where to")->required();
    options->session.add_to(command, *server);
    {
        const OptionGroup group(command, place_heading);
        add_stream_options(command, options->stream, *server);
        add_part_options(command, options->stream, *server, nullptr);
    }
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    options->verbosity.add_to(command);
    add_examples(command,
                 {"simulation | meniscus push - --server localhost --particle-radius 0.025",
                  "meniscus push recordings/SESSION/000001.recording --server localhost --answers answers.jsonl",
                  "cat frame_*.bricks | meniscus push - --server localhost --particle-radius 0.025"});
    command.callback([options] { push_and_tell(*options); });
}

}  // namespace meniscus::cli
