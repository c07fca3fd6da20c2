#include "recording/recording_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "meniscus/error.hpp"

namespace meniscus::server {

void require_recordable(const RecordingOptions& options) {
    if (options.directory.empty()) return;
    std::error_code ignored;
    const bool there = std::filesystem::exists(options.directory, ignored);
    if (there && !std::filesystem::is_directory(options.directory, ignored))
        throw InvalidInput(fmt::format("--record {}: not a directory", options.directory.string()));
    const std::filesystem::path place =
        there ? options.directory : std::filesystem::absolute(options.directory).parent_path();
    if (::access(place.c_str(), W_OK | X_OK) != 0)
        throw InvalidInput(fmt::format("--record {}: cannot be {}: {}", options.directory.string(),
                                       there ? "written to" : "created", std::generic_category().message(errno)));
}

}  // namespace meniscus::server
