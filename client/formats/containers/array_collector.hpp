// The arrays of a file as values of its particles or vertices: which are kept, as which type, under which name.
//
// float64 becomes float32. uint8 stays. Other integers of one component become ids: signed ones int32, unsigned ones
// uint32; int64 is uint32 where int32 does not hold it. Left out, with a reason: other forms than those of attributes,
// values that the type does not hold, names that are taken, and what comes after the first max_particle_arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/named_values.hpp"

namespace meniscus::formats {

/// A name of a file as one of arrays: lower case, other characters than a-z, 0-9 and _ become _, at most 64.
std::string array_name(std::string_view name);

/// One array in the making.
class ArrayBuilder {
public:
    /// name, type: as the file has them. count: of particles; the caller has checked that the file can hold them.
    ArrayBuilder(std::string_view name, ScalarType type, std::size_t components, std::size_t count);

    /// False: nothing comes of it, so that its values need not be read.
    bool wanted() const { return reason_.empty(); }
    /// The next number, in the order of the file.
    void add(double value);

private:
    friend class ArrayCollector;
    void add_integer(double value);
    void finish();

    NamedValues values_;
    ScalarType type_;
    std::size_t position_ = 0;  ///< bytes of values_.data that are there
    std::string reason_;        ///< why it is left out; empty: it is not
    bool negative_ = false;     ///< an integer is below 0
    bool above_int32_ = false;  ///< an integer is above the largest int32
};

/// Most arrays that a file may have, those with it that are left out.
inline constexpr std::size_t most_arrays = 4096;

/// The arrays of a file, gathered in its order.
class ArrayCollector {
public:
    /// at: of the file. add() and leave_out() throw by it for more than most_arrays.
    explicit ArrayCollector(const ByteCursor& at) : at_(at) {}

    void add(ArrayBuilder array);
    void leave_out(std::string_view name, std::string_view reason);

    /// Scalars that are components of one thing are put together first, where all of them are there and of one type:
    ///   red green blue [alpha] (uint8)   color
    ///   vx vy vz, or u v w               velocity
    ///   nx ny nz                         normal
    ///   N_x N_y N_z [N_w]                N
    /// left_out: a line for each array that is left out, "tensor (9 components)".
    void finish(std::vector<NamedValues>& arrays, std::vector<std::string>& left_out);

private:
    void expect_room() const;

    ByteCursor at_;
    std::vector<NamedValues> arrays_;
    std::vector<std::string> left_out_;
};

/// "has velocity (3 float32), id (uint32); left out: tensor (9 components)"; "has no arrays"
std::string described(const std::vector<NamedValues>& arrays, const std::vector<std::string>& left_out);

}  // namespace meniscus::formats
