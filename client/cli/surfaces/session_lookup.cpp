#include "cli/surfaces/session_lookup.hpp"

#include <cctype>
#include <cstddef>
#include <string_view>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::cli {
namespace {

/// Whether it can be nothing else: 8-4-4-4-12 hexadecimal digits.
bool has_form_of_id(const std::string& text) {
    constexpr std::string_view form = "00000000-0000-0000-0000-000000000000";
    if (text.size() != form.size()) return false;
    for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] == '-' ? text[i] != '-' : std::isxdigit(static_cast<unsigned char>(text[i])) == 0) return false;
    return true;
}

}  // namespace

std::string session_id_of(client::Client& client, const std::string& id_or_name) {
    if (has_form_of_id(id_or_name)) return id_or_name;
    const std::string shown = quoted(id_or_name, '"');
    std::vector<std::string> ids;
    // An empty name is none.
    if (!id_or_name.empty())
        for (const client::SessionInfo& session : client.sessions())
            if (session.description.name == id_or_name) ids.push_back(session.id);
    if (ids.empty()) throw InvalidInput("no session has the name or id " + shown + " (meniscus sessions lists them)");
    if (ids.size() == 1) return ids.front();
    std::string list;
    for (const std::string& id : ids) list += (list.empty() ? "" : ", ") + id;
    throw InvalidInput(std::to_string(ids.size()) + " sessions have the name " + shown +
                       "; say which by its id: " + list);
}

}  // namespace meniscus::cli
