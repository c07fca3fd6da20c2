#include "cli/sequence/recording_files.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <system_error>

#include "cli/options/option_group.hpp"
#include "files/recording_format.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) throw InvalidInput(folder.string() + ": no such folder");
    std::vector<std::filesystem::path> paths;
    std::error_code error;
    auto i = std::filesystem::recursive_directory_iterator(folder, error);
    for (; !error && i != std::filesystem::recursive_directory_iterator(); i.increment(error)) {
        if (i.depth() > 0) i.disable_recursion_pending();
        if (i->path().extension() == files::recording_extension) paths.push_back(i->path());
    }
    if (error) throw InvalidInput(folder.string() + ": cannot be read: " + error.message());
    std::sort(paths.begin(), paths.end());
    return paths;
}

bool is_recording(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path) || path.extension() == files::recording_extension) return true;
    // To open a pipe would wait for its writer, and take the bytes that are to be refused or read.
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    std::string beginning(files::recording_magic.size(), '\0');
    std::ifstream in(path, std::ios::binary);
    return in.read(beginning.data(), static_cast<std::streamsize>(beginning.size())) &&
           beginning == files::recording_magic;
}

void RecordingSelection::add_to(CLI::App& command) {
    const OptionGroup group(command, files_heading);
    command.add_option("RECORDING", path, "A file NNNNNN.recording, or a session's folder if it holds one only")
        ->required();
    add_range_to(command);
}

void RecordingSelection::add_range_to(CLI::App& command) {
    const OptionGroup group(command, files_heading);
    command.add_option("--from", from, "First frame, by its index (default: all)");
    command.add_option("--to", to, "Last frame, by its index");
}

formats::Recording RecordingSelection::open() const {
    std::filesystem::path file = path;
    if (std::filesystem::is_directory(file)) {
        const auto found = recordings_in(file);
        if (found.size() != 1)
            throw InvalidInput(path + ": holds " + std::to_string(found.size()) +
                               " recordings; name one (meniscus recordings lists them)");
        file = found.front();
    }
    formats::Recording recording(file);
    if (recording.cut_bytes() != 0)
        std::cerr << file.string() << ": its last " << recording.cut_bytes()
                  << " bytes are no whole frame and are left out: it was cut, or is being written\n";
    return recording;
}

}  // namespace meniscus::cli
