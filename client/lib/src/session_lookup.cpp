#include "meniscus/client/session_lookup.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::client {
namespace {

/// Whether it can be nothing else: 8-4-4-4-12 hexadecimal digits.
bool has_form_of_id(const std::string& text) {
    constexpr std::string_view form = "00000000-0000-0000-0000-000000000000";
    if (text.size() != form.size()) return false;
    for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] == '-' ? text[i] != '-' : std::isxdigit(static_cast<unsigned char>(text[i])) == 0) return false;
    return true;
}

struct Named {
    std::string id;
    std::string name;
};

/// "there are: "dam" (ID), ID"
std::string described(const std::vector<Named>& sessions) {
    constexpr std::size_t most_listed = 8;
    if (sessions.empty()) return "there is none";
    std::string out = "there are: ";
    for (std::size_t i = 0; i < std::min(sessions.size(), most_listed); ++i) {
        const Named& one = sessions[i];
        out += (i == 0 ? "" : ", ") + (one.name.empty() ? one.id : quoted(one.name, '"') + " (" + one.id + ")");
    }
    if (sessions.size() > most_listed) out += ", and " + std::to_string(sessions.size() - most_listed) + " more";
    return out;
}

/// what: a session has, in words.
std::string id_of(const std::string& name, const std::vector<Named>& sessions, const std::string& what) {
    const std::string shown = quoted(name, '"');
    std::vector<std::string> ids;
    // An empty name is none.
    for (const Named& session : sessions)
        if (!name.empty() && session.name == name) ids.push_back(session.id);
    if (ids.empty()) throw InvalidInput("no " + what + " has the name or id " + shown + "; " + described(sessions));
    if (ids.size() == 1) return ids.front();
    std::string list;
    for (const std::string& id : ids) list += (list.empty() ? "" : ", ") + id;
    throw InvalidInput(std::to_string(ids.size()) + " " + what + "s have the name " + shown +
                       "; say which by its id: " + list);
}

}  // namespace

std::string session_id_of(Client& client, const std::string& id_or_name, const std::stop_token& stop) {
    if (has_form_of_id(id_or_name)) return id_or_name;
    std::vector<Named> sessions;
    for (const SessionInfo& session : client.sessions(stop)) sessions.push_back({session.id, session.description.name});
    return id_of(id_or_name, sessions, "session");
}

std::string recorded_session_id_of(Client& client, const std::string& id_or_name, const std::stop_token& stop) {
    if (has_form_of_id(id_or_name)) return id_or_name;
    std::vector<Named> sessions;
    for (const RecordingInfo& recording : client.recordings(stop))
        // A session has one recording or more.
        if (std::ranges::find(sessions, recording.session_id, &Named::id) == sessions.end())
            sessions.push_back({recording.session_id, recording.description.name});
    return id_of(id_or_name, sessions, "recorded session");
}

}  // namespace meniscus::client
