#include "cli/commands/publish_sources.hpp"

#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/options/normals_by.hpp"
#include "cli/print/progress_bar.hpp"
#include "cli/print/statistics_text.hpp"
#include "cli/sequence/file_pattern.hpp"
#include "cli/sequence/recording_files.hpp"
#include "cli/surfaces/particle_input.hpp"
#include "files/publication_format.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/recordings/brick_file.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

/// A writer of frames that are all there already, and its messages.
class Publisher {
public:
    Publisher(const PublishCommand& command, const std::optional<Settings>& settings,
              const client::SessionDescription& described, std::size_t frames)
        : command_(command),
          writer_(command.folder, settings, publish_options(command, described)),
          bar_(frames, frames > 1 && !command.verbosity.quiet) {}

    bool has(std::uint64_t index) {
        if (!writer_.has(0, index)) return false;
        ++skipped_;
        bar_.advance();
        return true;
    }
    void add(client::ReceivedFrame frame) {
        frame.run_id = 0;
        writer_.add(frame, command_.frame_rate ? 1.0 / *command_.frame_rate : files::published_frame_seconds);
        bar_.advance();
    }
    void finish() {
        writer_.finish();
        bar_.erase();
        if (command_.verbosity.quiet) return;
        const client::PublicationInfo& info = writer_.info();
        std::cerr << command_.folder.string() << ": " << info.frames << " frames in " << info.segments.size()
                  << " segments of " << info.bytes << " bytes";
        if (skipped_ > 0) std::cerr << ", of which " << skipped_ << " were there before";
        std::cerr << '\n';
    }

private:
    const PublishCommand& command_;
    client::PublicationWriter writer_;
    ProgressBar bar_;
    std::size_t skipped_ = 0;
};

/// The files that SOURCE names, by their numbers; a single one is frame 0.
std::vector<NumberedFile> files_of(const PublishCommand& command) {
    FilePattern pattern(command.source);
    pattern.require_no_other_notation();
    if (!pattern.has_number()) return {{0, command.source}};
    std::vector<NumberedFile> files = command.selection.files(pattern);
    std::erase_if(files, [&](const NumberedFile& file) { return !command.is_wanted(file.number); });
    if (files.empty())
        throw InvalidInput(command.source + ": no number of its frames is a multiple of " +
                           std::to_string(command.every) + " (--every)");
    return files;
}

/// Reconstructs particles and encodes their surface.
class Encoder {
public:
    Encoder(const PublishCommand& command, const Settings& settings)
        : form_(command.form.build(settings)),
          codec_(form_.codec.value_or(Codec::lattice_entropy)),
          reconstructor_(settings, backend_of(command, codec_)) {}

    client::ReceivedFrame encode(const ParticleFrame& frame, std::uint64_t index, double time) {
        reconstructor_.reconstruct(frame, mesh_);
        const Statistics statistics = reconstructor_.statistics();
        if (form_.max_level < 3) reconstructor_.emit_capped(form_.max_level, mesh_);
        const CodingOptions coding{.normal_bits = client::asked_normal_bits(form_.normals_by, form_.normal_bits),
                                   .position_bits = form_.position_bits.value_or(0),
                                   .codec = codec_,
                                   .attributes = coded_attributes(mesh_, attribute_ranges(mesh_), form_.attributes)};
        return client::encode_frame(mesh_, statistics, index, time, coding);
    }

private:
    static BackendOptions backend_of(const PublishCommand& command, Codec codec) {
        BackendOptions backend = command.backend;
        backend.keep_lattice = needs_lattice(codec);
        return backend;
    }

    client::WatchOptions form_;
    Codec codec_;
    Reconstructor reconstructor_;
    Mesh mesh_;
};

/// Of particle files: --attribute names arrays.
Settings settings_of(const PublishCommand& command) {
    SettingsOptions options = command.settings;
    if (command.form.attributes != std::vector<std::string>{"none"}) options.set_attributes(command.form.attributes);
    return options.build(*command.particle_radius);
}

/// Refuses flags of particles where frames have their surface.
void require_no_settings(const PublishCommand& command, const std::string& what) {
    if (command.particle_radius || command.settings.any_given())
        throw InvalidInput(command.source + " is " + what +
                           ", whose surface is made: --particle-radius and the settings are of particle files");
}

bool is_form_given(const WatchFlags& form) {
    const client::WatchOptions standard;
    return form.normal_bits || form.options.normals_by != standard.normals_by || form.options.position_bits ||
           form.options.codec || form.options.max_level != standard.max_level || !form.attributes.empty();
}

}  // namespace

client::PublishOptions publish_options(const PublishCommand& command, const client::SessionDescription& described) {
    client::PublishOptions options{.description = command.description,
                                   .normals_by = command.form.options.normals_by,
                                   .keep_seconds = command.keep};
    if (options.description.name.empty()) options.description.name = described.name;
    if (options.description.length_unit.empty()) options.description.length_unit = described.length_unit;
    if (options.description.up_axis == client::UpAxis::unspecified) options.description.up_axis = described.up_axis;
    return options;
}

void publish_particles(const PublishCommand& command) {
    if (!command.particle_radius)
        throw InvalidInput("--particle-radius is needed: " + quoted(command.source) + " is taken for particles");
    const std::vector<NumberedFile> files = files_of(command);
    const Settings settings = settings_of(command);
    check_normals_by(command.form.options.normals_by, command.form.normal_bits, false);
    Publisher publisher(command, settings, {}, files.size());
    PublishCommand with_all = command;  // of the attributes that the settings name
    with_all.form.attributes.clear();
    Encoder encoder(with_all, settings);
    ParticleInputOptions how;
    how.format = command.input_format;
    how.limits = command.limits;
    for (const auto& [number, path] : files) {
        if (publisher.has(number)) continue;
        const ParticleInput input(path, how, settings);
        client::ReceivedFrame frame;
        try {
            frame = encoder.encode(input.frame(), number,
                                   command.frame_rate ? static_cast<double>(number) / *command.frame_rate : 0.0);
        } catch (const InvalidInput& error) {
            throw InvalidInput(path.string() + ": " + error.what());
        } catch (const LimitExceeded& error) {
            throw LimitExceeded(path.string() + ": " + error.what());
        }
        publisher.add(std::move(frame));
    }
    publisher.finish();
}

void publish_bricks(const PublishCommand& command) {
    require_no_settings(command, "a file of bricks");
    if (is_form_given(command.form))
        throw InvalidInput(command.source +
                           " has bricks, which are published as they are: leave out the flags of their form");
    const std::vector<NumberedFile> files = files_of(command);
    // A file of bricks does not name its settings.
    Publisher publisher(command, std::nullopt, {}, files.size());
    for (const auto& [number, path] : files) {
        if (publisher.has(number)) continue;
        client::ReceivedFrame frame =
            formats::read_bricks(path.string(), formats::read_file(path, command.limits.most_bytes));
        frame.index = number;
        publisher.add(std::move(frame));
    }
    publisher.finish();
}

void publish_recording(const PublishCommand& command) {
    require_no_settings(command, "a recording");
    check_normals_by(command.form.options.normals_by, command.form.normal_bits, false);
    RecordingSelection selection;
    selection.path = command.source;
    const formats::Recording recording = selection.open();
    std::vector<formats::RecordedFrame> frames;
    for (const formats::RecordedFrame& frame : recording.frames())
        if (command.is_wanted(frame.index)) frames.push_back(frame);
    if (frames.empty()) throw InvalidInput(command.source + ": none of its frames is wanted (--start, --end, --every)");
    Publisher publisher(command, recording.settings(), recording.description(), frames.size());
    const bool as_recorded = !is_form_given(command.form);
    std::optional<Encoder> encoder;
    for (const formats::RecordedFrame& frame : frames) {
        if (publisher.has(frame.index)) continue;
        if (frame.mesh && as_recorded) {
            publisher.add(recording.mesh(frame));
            continue;
        }
        if (!encoder) encoder.emplace(command, recording.settings());
        const formats::RecordedParticles particles = recording.particles(frame);
        const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
        ParticleFrame view = particles.view();
        view.arrays = arrays;
        publisher.add(encoder->encode(view, frame.index, frame.simulation_time));
    }
    publisher.finish();
}

}  // namespace meniscus::cli
