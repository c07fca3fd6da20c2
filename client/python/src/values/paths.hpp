// Paths from Python: texts or bytes, as os.fspath() gives them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <filesystem>

namespace meniscus::python {

/// Throws InvalidInput for a path that no file can have.
std::filesystem::path path_of(const pybind11::object& path);

/// The value of the keyword max_bytes; of None, that which is usual. Throws InvalidInput for a value that is no such
/// number.
std::uint64_t size_limit(const pybind11::object& max_bytes);
/// Throws LimitExceeded for a file that is larger. What is larger once it is decompressed is refused where it is read.
void check_size(const std::filesystem::path& path, std::uint64_t most_bytes);

}  // namespace meniscus::python
