// VTK's XML for polygonal data: arrays described by XML, their bytes appended raw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

enum class VtpCompression { none, zlib };

/// Gathers a file with one piece.
class VtpWriter {
public:
    explicit VtpWriter(VtpCompression compression) : compression_(compression) {}

    /// Begins an element of arrays: "Points", "PointData", "CellData", "Verts", "Polys". attributes: of it, "" or
    /// " Normals=\"Normals\"".
    void begin(std::string_view element, std::string_view attributes = {});
    /// An array in it. type: VTK's, "Float32". bytes: little-endian.
    void add(std::string_view name, std::string_view type, std::size_t components, std::string_view bytes);
    void add(const ParticleArray& array);
    void end(std::string_view element);

    /// Writes it, atomically. verts, polys: how many there are.
    void write(const std::filesystem::path& path, std::size_t points, std::size_t verts, std::size_t polys) const;

private:
    VtpCompression compression_;
    std::string elements_;
    std::string appended_;
};

/// The numbers of an array as bytes, where they lie.
template <class Number>
std::string_view bytes_of(const Number* numbers, std::size_t count) {
    return {reinterpret_cast<const char*>(numbers), count * sizeof(Number)};
}

}  // namespace meniscus::formats
