// numpy's .npy (numpy.lib.format): one array of numbers.
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "meniscus/element_type.hpp"

namespace meniscus::formats {

/// Borrowed from the file's bytes.
struct NpyArray {
    ScalarType type = ScalarType::float32;
    std::endian order = std::endian::little;
    bool fortran = false;  ///< the first index runs fastest
    std::vector<std::size_t> shape;
    std::string_view data;
    std::string unread;  ///< why its values cannot be read, "pickled Python objects": `data` is what the file has

    /// Whether it has `count` rows of some numbers each.
    bool has_rows(std::size_t count) const {
        return unread.empty() && (shape.size() == 1 || shape.size() == 2) && shape[0] == count;
    }
    std::size_t columns() const { return shape.size() == 2 ? shape[1] : 1; }
    /// row, column: of has_rows().
    double at(std::size_t row, std::size_t column) const {
        const std::size_t index = fortran ? column * shape[0] + row : row * columns() + column;
        return load_scalar(type, data.data() + index * size_of(type), order);
    }
};

/// Most sizes of a shape, as numpy has it.
inline constexpr std::size_t most_dimensions = 64;

/// "(3, 4)", with "..." in place of what comes after the first eight sizes.
std::string shape_text(const std::vector<std::size_t>& shape);

/// The name that numpy has for the type of an array, little-endian: "<f4".
std::string_view npy_name_of(ElementType type);

/// The type and the byte order, or why its values cannot be read. name: as numpy names the type, "<f4".
void set_npy_type(NpyArray& array, std::string_view name);

/// at: of the file. Throws by it unless the bytes are an array, of the size that its header announces.
NpyArray read_npy_array(const ByteCursor& at, std::string_view bytes);

/// The header of an array in C order. descr: as numpy names the type, "<f4".
std::string npy_header(std::string_view descr, const std::vector<std::size_t>& shape);

}  // namespace meniscus::formats
