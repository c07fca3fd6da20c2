// The extension of a file name, which decides about the format.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace meniscus::formats {

/// The extension with its dot, in lower case; empty without one.
inline std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

}  // namespace meniscus::formats
