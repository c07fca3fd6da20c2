#include "cli/sequence/distinct_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

/// None for what is not there, and for what cannot be destroyed, such as a pipe.
std::optional<DistinctFiles::Identity> DistinctFiles::identity(const std::filesystem::path& path, int standard_stream) {
    struct stat status {};
    const int failed =
        formats::is_standard_stream(path) ? ::fstat(standard_stream, &status) : ::stat(path.c_str(), &status);
    if (failed != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}

void DistinctFiles::add_input(const std::filesystem::path& path) {
    if (const auto file = identity(path, STDIN_FILENO)) inputs_.emplace(*file, path);
}

void DistinctFiles::add_output(const std::filesystem::path& path) {
    const auto refuse = [&](const std::string& why) {
        throw InvalidInput(formats::output_name(path) + ": cannot be written: " + why + "; name another file");
    };
    if (const auto file = identity(path, STDOUT_FILENO)) {
        const auto input = inputs_.find(*file);
        if (input != inputs_.end()) refuse("it is the file of the input " + formats::input_name(input->second));
        const auto [output, is_new] = outputs_.emplace(*file, path);
        if (!is_new) refuse("it is the file of the output " + formats::output_name(output->second));
    }
    std::error_code error;
    const auto name = formats::is_standard_stream(path) ? path : std::filesystem::weakly_canonical(path, error);
    const auto [output, is_new] = output_names_.emplace(error ? path : name, path);
    if (!is_new) refuse("it is the file of the output " + formats::output_name(output->second));
}

}  // namespace meniscus::cli
