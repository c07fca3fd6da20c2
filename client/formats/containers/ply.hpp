// The PLY container: a header that describes rows of numbers, then the rows. Used for particles and for meshes.
//
// By hand: Debian has no small library for it, and files of others are checked here against their own size before
// memory is taken for what they claim.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"

namespace meniscus::formats {

struct PlyProperty {
    std::string name;
    ScalarType type = ScalarType::float32;      ///< type of the value, or of a list's items
    std::optional<ScalarType> list_count_type;  ///< set for a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the scalar property of that name, if there is one.
    std::optional<std::size_t> scalar(std::string_view property) const;
    /// Index of the list property of that name, if there is one.
    std::optional<std::size_t> list(std::string_view property) const;
};

/// Values of one row by property index: `lists` holds those of lists, `scalars` all others.
struct PlyRow {
    std::vector<double> scalars;
    std::vector<std::vector<double>> lists;
};

/// Reads ascii, binary_little_endian and binary_big_endian 1.0.
class PlyReader {
public:
    /// Reads the header. Throws InvalidInput if it is not one.
    PlyReader(const std::string& name, std::string_view bytes, const ReadLimits& limits);

    const std::vector<PlyElement>& elements() const { return elements_; }
    ByteCursor& in() { return in_; }
    ReadBudget& budget() { return budget_; }

    /// Throws InvalidInput unless `element.count` rows can still follow. To be called before memory is allocated for
    /// them.
    void expect_rows(const PlyElement& element) const;
    /// Calls `row` with each row of the next element. Elements are read in the order of the header.
    void read_rows(const PlyElement& element, const std::function<void(std::size_t index, const PlyRow&)>& row);
    /// Throws InvalidInput if anything but white space follows the last element.
    void expect_end();

private:
    double next(ScalarType type);

    ByteCursor in_;
    ReadBudget budget_;
    std::optional<std::endian> binary_;  ///< none for ascii
    std::vector<PlyElement> elements_;
};

}  // namespace meniscus::formats
