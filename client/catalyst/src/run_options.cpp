#include "run_options.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "c_options.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "text_options/attribute_options.hpp"
#include "text_options/client_options.hpp"

namespace meniscus::catalyst {
namespace {

using text_options::OptionReader;
using text_options::Options;

/// Why the C interface does not know an option of this name; empty if it does.
std::string unknown(const std::string& name) {
    if (name == "server" || name == "channel") return {};
    const COptions options = c_options({});
    if (meniscus_options_set(options.get(), name.c_str(), "") == MENISCUS_OK) return {};
    return meniscus_error_message();
}

/// name=value of a text, in order.
std::vector<std::pair<std::string, std::string>> pairs_of(std::string_view text) {
    std::vector<std::pair<std::string, std::string>> pairs;
    constexpr std::string_view spaces = " \t\r\n";
    for (std::size_t first = text.find_first_not_of(spaces); first != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(spaces, first), text.size());
        const std::string word(text.substr(first, end - first));
        const std::size_t equals = word.find('=');
        if (equals != std::string::npos && equals != 0)
            pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
        else if (!pairs.empty() && equals == std::string::npos)
            pairs.back().second += " " + word;
        else
            throw InvalidInput("options begin with " + quoted(word) +
                               ", must be such as particle-radius=0.025 server=127.0.0.1:50051");
        first = text.find_first_not_of(spaces, end);
    }
    return pairs;
}

void read_script(const Node& script, Options& options, Notices& notices) {
    if (const auto file = script.text() ? script.text() : script.at("filename").text())
        notices.say_once("script " + quoted(*file) + " is passed over: no scripts are run here, only args are read");
    const Node args = script.at("args");
    std::vector<std::string> words;
    if (const auto alone = args.text()) words.push_back(*alone);
    for (const Node& word : args.children())
        if (const auto text = word.text()) words.push_back(*text);
    for (const std::string& word : words) {
        if (word.find('=') == std::string::npos) {
            notices.say_once("argument " + quoted(word) + " of a script is passed over, options are NAME=VALUE");
            continue;
        }
        for (auto& [name, value] : pairs_of(word)) {
            if (const std::string reason = unknown(name); !reason.empty())
                notices.say_once(reason + "; passed over");
            else
                options.insert_or_assign(name, std::move(value));
        }
    }
}

std::string taken(Options& options, const std::string& name) {
    const auto found = options.find(name);
    if (found == options.end()) return {};
    std::string value = std::move(found->second);
    options.erase(found);
    return value;
}

}  // namespace

RunOptions read_run_options(const Node& params, const char* environment, Notices& notices) {
    Options options;
    for (const Node& script : params.at("catalyst/scripts").children()) read_script(script, options, notices);
    for (auto& [name, value] : pairs_of(environment == nullptr ? "" : environment)) {
        if (const std::string reason = unknown(name); !reason.empty())
            throw InvalidInput("MENISCUS_CATALYST: " + reason);
        options.insert_or_assign(name, std::move(value));
    }
    RunOptions run;
    run.output = taken(options, "output");
    run.makes_surfaces = options.contains("reconstruct-ranks") || !run.output.empty();
    options.try_emplace("policy", "latest");
    if (!run.makes_surfaces) options.try_emplace("meshes", "false");
    run.server = taken(options, "server");
    run.channel = taken(options, "channel");
    if (run.server.empty() == run.output.empty())
        throw InvalidInput(std::string("options 'server' and 'output' are ") +
                           (run.server.empty() ? "missing" : "both set") +
                           ", must be either server=HOST:PORT of a meniscusd, as in "
                           "MENISCUS_CATALYST=\"server=127.0.0.1:50051 particle-radius=0.025\", or output=FOLDER for "
                           "files of surfaces");
    Settings settings;
    OptionReader attributes(&options);
    text_options::read_attributes(attributes, settings);
    run.all_attributes = settings.all_attributes;
    run.attributes = std::move(settings.attributes);
    OptionReader connection(&options);
    text_options::read_connection(connection);
    for (auto& [name, value] : options) {
        const bool connects = std::ranges::find(connection.known(), name) != connection.known().end();
        (connects ? run.connection : run.session).emplace(name, value);
    }
    return run;
}

}  // namespace meniscus::catalyst
