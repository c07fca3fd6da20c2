#include "options/settings_sources.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

#include "meniscus/error.hpp"
#include "meniscus/near_name.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view prefix = "MENISCUS_";

/// The file's own name; variables of the libraries, of the client, of the tests and benchmarks; and those that
/// Kubernetes sets for a service named meniscus.
bool is_no_setting(std::string_view variable) {
    constexpr std::array<std::string_view, 9> others{
        "MENISCUS_CONFIG",    "MENISCUS_INSTRUCTIONS", "MENISCUS_PROGRAM", "MENISCUS_CATALYST", "MENISCUS_TOKEN",
        "MENISCUS_SERVER_CA", "MENISCUS_SERVER_NAME",  "MENISCUS_DATA",    "MENISCUS_COMMIT"};
    return std::find(others.begin(), others.end(), variable) != others.end() ||
           variable.starts_with("MENISCUS_SERVICE_") || variable.starts_with("MENISCUS_PORT");
}

std::string flag_of(std::string_view variable) {
    std::string flag(variable.substr(prefix.size()));
    for (char& c : flag) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return flag;
}

/// Whether an option may be set elsewhere than on the command line.
bool is_setting(const CLI::Option* option) {
    return option->get_configurable();
}

std::string unknown(const Setting& setting, const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options(is_setting)) names.push_back(option->get_lnames().front());
    const std::string nearest = near_name(setting.name, names);
    const std::string hint = nearest.empty() ? "" : fmt::format("; --{} is near it", nearest);
    return fmt::format("{}: there is no setting of this name{} (see meniscusd --help)", setting.where, hint);
}

}  // namespace

std::vector<Setting> environment_settings(const char* const* environment) {
    std::vector<Setting> settings;
    for (; *environment != nullptr; ++environment) {
        const std::string_view entry(*environment);
        const std::size_t equals = entry.find('=');
        if (!entry.starts_with(prefix) || equals == std::string_view::npos) continue;
        const std::string_view variable = entry.substr(0, equals);
        const std::string_view value = entry.substr(equals + 1);
        if (value.empty() || is_no_setting(variable)) continue;
        settings.push_back({.name = flag_of(variable),
                            .value = std::string(value),
                            .where = fmt::format("environment variable {}", variable)});
    }
    return settings;
}

std::vector<Setting> file_settings(const std::string& path) {
    // A pipe will do, but not one without an end.
    constexpr std::size_t limit = std::size_t{1} << 20;
    std::ifstream stream(path, std::ios::binary);
    std::string text(limit + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    // A folder can be opened, but not read.
    if (!stream.is_open() || stream.bad())
        throw InvalidInput(fmt::format("--config {}: no such file, or it cannot be read", path));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > limit)
        throw InvalidInput(fmt::format("--config {} has more than {} bytes: it is no file of settings", path, limit));
    std::istringstream file(text);
    std::vector<Setting> settings;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        const std::string setting = CLI::detail::trim_copy(line);
        if (setting.empty() || setting.starts_with('#')) continue;
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos)
            throw InvalidInput(fmt::format("{}:{}: \"{}\" is no setting; a line is FLAG = VALUE, or begins with #",
                                           path, number, setting.substr(0, 64)));
        const std::string name = CLI::detail::trim_copy(setting.substr(0, equals));
        settings.push_back({.name = name,
                            .value = CLI::detail::trim_copy(setting.substr(equals + 1)),
                            .where = fmt::format("{}:{}: {}", path, number, name)});
    }
    return settings;
}

std::vector<std::string> apply_settings(const std::vector<Setting>& settings, CLI::App& app) {
    std::vector<std::string> errors;
    std::set<std::string> seen;
    for (const Setting& setting : settings) {
        CLI::Option* option = app.get_option_no_throw("--" + setting.name);
        if (option == nullptr || !is_setting(option)) {
            errors.push_back(unknown(setting, app));
            continue;
        }
        if (!seen.insert(setting.name).second) {
            errors.push_back(fmt::format("{} is there twice", setting.where));
            continue;
        }
        if (option->count() != 0) continue;
        try {
            option->add_result(setting.value);
            option->run_callback();
        } catch (const CLI::Error& error) {
            errors.push_back(fmt::format("{}: {}", setting.where, error.what()));
        } catch (const InvalidInput& error) {
            errors.push_back(fmt::format("{}: {}", setting.where, error.what()));
        }
    }
    return errors;
}

std::string settings_file(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : app.get_options(is_setting)) {
        const bool is_flag = option->get_expected_min() == 0;
        std::string value =
            option->count() != 0 ? CLI::detail::join(option->reduced_results(), ",") : option->get_default_str();
        if (value.empty() && is_flag) value = "false";
        text += fmt::format("# {}\n{}{} ={}{}\n", option->get_description(), value.empty() ? "# " : "",
                            option->get_lnames().front(), value.empty() ? "" : " ", value);
    }
    return text;
}

}  // namespace meniscus::server
