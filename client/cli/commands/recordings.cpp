// meniscus recordings: the recordings in a folder, or on a server.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/print/settings_json.hpp"
#include "cli/print/times.hpp"
#include "cli/sequence/recording_files.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::cli {
namespace {

/// The name with a space before it, for a line of text; empty where there is none.
std::string after_space(const std::string& name) {
    return name.empty() ? "" : " " + quoted(name, '"');
}

nlohmann::ordered_json describe(const client::SessionDescription& description) {
    return {{"name", description.name},
            {"up_axis", name_of(description.up_axis)},
            {"length_unit", description.length_unit}};
}

double seconds(const std::vector<formats::RecordedFrame>& frames) {
    if (frames.empty()) return 0.0;
    return std::chrono::duration<double>(frames.back().arrived_at - frames.front().arrived_at).count();
}

nlohmann::ordered_json describe(const formats::Recording& recording, bool verify) {
    const auto& frames = recording.frames();
    nlohmann::ordered_json out;
    out["session"] = recording.session_id();
    out.update(describe(recording.description()));
    out["started_at"] = utc(recording.started_at());
    out["frames"] = frames.size();
    if (!frames.empty()) {
        out["first_index"] = frames.front().index;
        out["last_index"] = frames.back().index;
    }
    out["meshes"] =
        std::count_if(frames.begin(), frames.end(), [](const auto& frame) { return frame.mesh.has_value(); });
    out["seconds"] = seconds(frames);
    out["bytes"] = recording.bytes();
    out["cut_bytes"] = recording.cut_bytes();
    out["checksums"] = recording.has_checksums();
    if (verify) {
        auto& damaged = out["damaged_frames"] = nlohmann::ordered_json::array();
        for (const formats::RecordedFrame& frame : frames)
            if (!recording.is_whole(frame)) damaged.push_back(frame.index);
    }
    out["settings"] = to_json(recording.settings());
    return out;
}

void print(const nlohmann::ordered_json& recording) {
    std::cout << visible(recording["file"].get<std::string>()) << "  ";
    if (recording.contains("error")) {
        std::cout << "unreadable: " << visible(recording["error"].get<std::string>()) << '\n';
        return;
    }
    const auto& settings = recording["settings"];
    std::cout << recording["started_at"].get<std::string>() << after_space(recording["name"].get<std::string>()) << "  "
              << recording["frames"] << " frames";
    if (recording.contains("first_index"))
        std::cout << " (" << recording["first_index"] << " to " << recording["last_index"] << ")";
    std::cout << ", " << recording["meshes"] << " meshes, " << recording["seconds"].get<double>() << " s, "
              << recording["bytes"] << " bytes; particle radius " << settings["particle_radius"].get<double>()
              << ", cell size " << settings["cell_size"].get<double>() << ", " << settings["mode"].get<std::string>();
    if (recording["cut_bytes"] != 0)
        std::cout << "; its last " << recording["cut_bytes"] << " bytes are no whole frame";
    if (recording.contains("damaged_frames") && !recording["damaged_frames"].empty())
        std::cout << "; damaged: frames " << recording["damaged_frames"].dump();
    std::cout << '\n';
}

struct RecordingsOptions {
    std::string folder;
    std::vector<std::string> deleted;  ///< SESSION/NUMBER, as they are listed
    ServerFlags server;
    bool json = false;
    bool quick = false;
};

nlohmann::ordered_json describe(const client::RecordingInfo& recording) {
    nlohmann::ordered_json out;
    out["session"] = recording.session_id;
    out["number"] = recording.number;
    out.update(describe(recording.description));
    out["owner"] = recording.owner;
    out["started_at"] = utc(recording.started_at);
    out["frames"] = recording.frames;
    if (recording.first_frame_index) out["first_index"] = *recording.first_frame_index;
    if (recording.last_frame_index) out["last_index"] = *recording.last_frame_index;
    out["bytes"] = recording.bytes;
    out["being_written"] = recording.being_written;
    out["damaged"] = recording.damaged;
    return out;
}

void list_of_server(const RecordingsOptions& options) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const client::RecordingInfo& recording : options.server.connect().recordings()) {
        if (options.json) {
            all.push_back(describe(recording));
            continue;
        }
        std::cout << recording.session_id << '/' << recording.number << after_space(recording.description.name) << "  "
                  << utc(recording.started_at) << "  " << recording.frames << " frames";
        if (recording.first_frame_index && recording.last_frame_index)
            std::cout << " (" << *recording.first_frame_index << " to " << *recording.last_frame_index << ")";
        std::cout << ", " << recording.bytes << " bytes" << (recording.being_written ? ", being written" : "")
                  << (recording.damaged ? ", damaged behind them" : "") << '\n';
    }
    if (options.json) std::cout << nlohmann::ordered_json{{"recordings", all}}.dump(2) << '\n';
}

struct RecordingName {
    std::string session_id;
    std::uint32_t number = 0;
};

/// Throws InvalidInput for anything but SESSION/NUMBER.
RecordingName named(const std::string& text) {
    const std::size_t slash = text.find('/');
    RecordingName name{.session_id = text.substr(0, slash)};
    const char* const end = text.data() + text.size();
    const char* const digits = slash == std::string::npos ? end : text.data() + slash + 1;
    const auto [rest, error] = std::from_chars(digits, end, name.number);
    if (error != std::errc{} || rest != end || name.session_id.empty() || name.number == 0)
        throw InvalidInput("--delete is \"" + text +
                           "\"; it must be SESSION/NUMBER, as meniscus recordings --server lists them");
    return name;
}

/// Deletes recordings one by one. If the server refuses one, those before it are gone.
void delete_of_server(const RecordingsOptions& options) {
    std::vector<RecordingName> names;
    for (const std::string& text : options.deleted) names.push_back(named(text));
    client::Client client = options.server.connect();
    for (const RecordingName& name : names) {
        client.delete_recording(name.session_id, name.number);
        std::cout << "deleted " << name.session_id << '/' << name.number << '\n';
    }
}

void list(const RecordingsOptions& options) {
    if (!options.deleted.empty()) return delete_of_server(options);
    if (!options.server.address.empty()) return list_of_server(options);
    if (options.folder.empty()) throw InvalidInput("name a folder, or a server by --server");

    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const auto& path : recordings_in(options.folder)) {
        nlohmann::ordered_json recording{{"file", path.string()}};
        // One bad file does not hide the others.
        try {
            recording.update(describe(formats::Recording(path), !options.quick));
        } catch (const InvalidInput& e) {
            recording["error"] = e.what();
        }
        if (options.json)
            all.push_back(std::move(recording));
        else
            print(recording);
    }
    if (options.json) std::cout << nlohmann::ordered_json{{"recordings", all}}.dump(2) << '\n';
}

}  // namespace

void add_recordings(CLI::App& app) {
    auto options = std::make_shared<RecordingsOptions>();
    CLI::App& command = *app.add_subcommand("recordings", "List the recordings that meniscusd --record DIR has made");
    CLI::Option* folder = command.add_option("DIR", options->folder, "The folder, or one session's folder in it");
    CLI::Option* server =
        options->server.add_to(command, "List the recordings of this server instead")->excludes(folder);
    command.add_option("--delete", options->deleted, "Delete these recordings of the server, which must be at rest")
        ->needs(server)
        ->type_name("SESSION/NUMBER");
    command.add_flag("--json", options->json, "As JSON, with all settings");
    command.add_flag("--quick", options->quick, "Do not read the frames to verify their checksums");
    add_examples(command,
                 {"meniscus recordings /var/lib/meniscus --quick", "meniscus recordings --server localhost --json"});
    command.callback([options] { list(*options); });
}

}  // namespace meniscus::cli
