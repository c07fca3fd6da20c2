// Arrays to numpy's .npz.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/containers/zip_archive.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// Writes atomically: what add() was given, once commit() has been called.
class NpzWriter {
public:
    explicit NpzWriter(const std::filesystem::path& path) : zip_(path) {}

    /// descr: numpy's name of the type, "<f4". bytes: in C order, little-endian.
    void add(const std::string& name, std::string_view descr, const std::vector<std::size_t>& shape,
             std::string_view bytes);
    /// Adds an array with a row for each point.
    void add(const ParticleArray& array);
    void commit() { zip_.commit(); }

private:
    ZipWriter zip_;
};

}  // namespace meniscus::formats
