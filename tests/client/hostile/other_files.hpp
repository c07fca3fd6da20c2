// HDF5 files with particles that lie in other files: whoever reads them hands out what he may read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::test {

struct OtherFile {
    std::string way;             ///< in which it leads to the other one
    std::filesystem::path path;  ///< of the HDF5 file
    std::string other;           ///< the name that it has for the other file
};

/// Writes them to the folder, with the files that they lead to; the numbers there are 6364136. Empty in a build without
/// HDF5.
std::vector<OtherFile> write_files_with_others(const std::filesystem::path& folder);

}  // namespace meniscus::test
