// Settings from the environment and from a file, for what the command line leaves open; and how a file states them.
//
// A file has one setting a line: the flag without "--", "=", the value up to the end of the line. Lines that begin with
// # are comments.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace meniscus::server {

struct Setting {
    std::string name;  ///< of the flag, without "--"
    std::string value;
    std::string where;  ///< for messages
};

/// MENISCUS_MAX_SESSIONS for --max-sessions, and so on. environment: "NAME=VALUE", ended by a null pointer. An empty
/// value counts as none.
std::vector<Setting> environment_settings(const char* const* environment);

/// Throws InvalidInput if the file cannot be read or a line is no setting.
std::vector<Setting> file_settings(const std::string& path);

/// Sets the options that have no value yet, so that the first source to be applied wins. Returns a line for each
/// setting that is unknown or whose value is wrong.
std::vector<std::string> apply_settings(const std::vector<Setting>& settings, CLI::App& app);

/// The values in effect, as a file that gives them again.
std::string settings_file(const CLI::App& app);

}  // namespace meniscus::server
