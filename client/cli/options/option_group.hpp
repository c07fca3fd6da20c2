// Headings of --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace meniscus::cli {

/// Options that are added to the command while this lives stand below its heading, in the order of the headings' first
/// options.
class OptionGroup {
public:
    OptionGroup(CLI::App& command, const std::string& heading)
        : command_(command), heading_before_(command.option_defaults()->get_group()) {
        command_.option_defaults()->group(heading);
    }
    ~OptionGroup() { command_.option_defaults()->group(heading_before_); }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

private:
    CLI::App& command_;
    std::string heading_before_;
};

/// The headings that several commands have.
inline constexpr const char* files_heading = "Files";
inline constexpr const char* sequence_heading = "Sequences";
inline constexpr const char* surface_heading = "Surface";
inline constexpr const char* grid_heading = "Grid";
inline constexpr const char* mesh_heading = "The mesh that is written";
inline constexpr const char* place_heading = "Place of the reconstruction";
inline constexpr const char* session_heading = "The session on the server";
inline constexpr const char* server_heading = "Reaching a server";
inline constexpr const char* other_heading = "Other";

}  // namespace meniscus::cli
