// meniscus sessions: the sessions of a server.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/print/session_table.hpp"
#include "cli/print/settings_json.hpp"
#include "cli/print/times.hpp"
#include "meniscus/client/session_lookup.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

struct SessionsOptions {
    ServerFlags server;
    std::vector<std::string> remove;  ///< ids or names
    bool json = false;
};

nlohmann::ordered_json session_json(const client::SessionInfo& session) {
    nlohmann::ordered_json out;
    out["id"] = session.id;
    out["name"] = session.description.name;
    out["up_axis"] = name_of(session.description.up_axis);
    out["length_unit"] = session.description.length_unit;
    out["created_at"] = utc(session.created_at);
    out["settings"] = to_json(session.settings);
    out["ephemeral"] = session.ephemeral;
    out["published"] = session.published;
    out["owner"] = session.owner;
    out["uploading"] = session.uploading;
    out["watchers"] = session.watchers;
    out["frames"] = session.frames;
    out["frames_dropped"] = session.frames_dropped;
    out["frames_skipped"] = session.frames_skipped;
    if (session.last_frame_index) out["last_frame_index"] = *session.last_frame_index;
    if (!session.last_frame) return out;
    const client::FrameStatistics& last = *session.last_frame;
    out["last_frame"] = {{"particles", last.particles},           {"vertices", last.vertices},
                         {"triangles", last.triangles},           {"total_seconds", last.total_seconds},
                         {"encode_seconds", last.encode_seconds}, {"latency_seconds", last.latency_seconds},
                         {"encoded_bytes", last.encoded_bytes},   {"peak_bytes", last.peak_bytes},
                         {"device_bytes", last.device_bytes},     {"backend", last.backend}};
    return out;
}

/// Deletes all sessions that can be deleted; one that cannot does not keep the others.
void delete_sessions(const SessionsOptions& options) {
    client::Client client = options.server.connect();
    std::string failures;
    for (const std::string& session : options.remove) {
        try {
            const std::string id = session_id_of(client, session);
            client.delete_session(id, {.unpublish = true});
            std::cout << "deleted " << id << '\n';
        } catch (const std::exception& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    }
    if (!failures.empty()) throw InvalidInput(failures);
}

void print_sessions(const SessionsOptions& options) {
    const std::vector<client::SessionInfo> sessions = options.server.connect().sessions();
    if (options.json) {
        auto all = nlohmann::ordered_json::array();
        for (const client::SessionInfo& session : sessions) all.push_back(session_json(session));
        std::cout << all.dump(2) << '\n';
        return;
    }
    if (sessions.empty()) {
        std::cerr << "meniscus: " << options.server.address << " has no sessions\n";
        return;
    }
    std::vector<SessionRow> rows;
    rows.reserve(sessions.size());
    for (const client::SessionInfo& session : sessions) rows.push_back({session, std::nullopt});
    std::cout << session_table(rows);
}

}  // namespace

void add_sessions(CLI::App& app) {
    auto options = std::make_shared<SessionsOptions>();
    CLI::App& command = *app.add_subcommand("sessions", "List a server's sessions, or end some");
    options->server.add_to(command, "Whose")->required();
    CLI::Option* json = command.add_flag("--json", options->json, "As JSON, exact");
    command
        .add_option("--delete", options->remove,
                    "End these sessions, each named by its id, or by its name if no other session has that; what they "
                    "have published goes, too, also that of an id whose session has ended")
        ->type_name("SESSION ...")
        ->excludes(json);
    add_examples(command, {"meniscus sessions --server localhost", "meniscus sessions --server localhost --json",
                           "meniscus sessions --server localhost --delete SESSION"});
    command.callback([options] {
        if (options->remove.empty())
            print_sessions(*options);
        else
            delete_sessions(*options);
    });
}

}  // namespace meniscus::cli
