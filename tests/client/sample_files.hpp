// Small files of every format that is read, and what the tests share.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/mesh.hpp"

namespace meniscus::test {

/// A directory that is removed with all its files.
class TemporaryDirectory {
public:
    TemporaryDirectory();
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// The folder with real frames; none if MENISCUS_DATA is not set.
std::optional<std::filesystem::path> data_folder();

/// A well-formed file, and the function that reads its format.
struct Sample {
    std::string name;
    std::string bytes;
    std::function<void(const std::string& bytes)> read;
};

/// One or more samples of every format.
std::vector<Sample> samples();

/// Legacy VTK 4.1, binary: two points, ids, a level array between two others.
std::string vtk_binary();
/// The same content as legacy VTK 5.1, ASCII, with OFFSETS, CONNECTIVITY and METADATA.
std::string vtk_ascii();

/// A closed tetrahedron at the given lattice origin, its four triangles of level 1, 2, 3 and crack.
Mesh tetrahedron(std::int32_t origin = 0);

/// The message of the InvalidInput that `call` throws; empty if it does not throw.
std::string refusal(const std::function<void()>& call);

}  // namespace meniscus::test
