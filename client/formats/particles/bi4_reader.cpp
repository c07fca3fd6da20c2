// DualSPHysics' .bi4, one file a step (Part_0000.bi4) or a case: a header of 64 bytes, then a tree of items. An item
// has named values, arrays and further items; the step's arrays are Pos (or Posd, float64), Idp (or Idpd), Vel, Rhop.
// Texts and lists begin with their sizes. Particles of walls and bodies, which have the first ids, are left out.
#include <array>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {
namespace {

constexpr std::string_view bi4_title = "#FileJBD ";
constexpr std::size_t bi4_header_bytes = 64;
/// The place of the header's byte of order: 0 little-endian, 1 big-endian; 10 more with sizes of 64 bits.
constexpr std::size_t bi4_order_byte = 60;
constexpr int bi4_wide_sizes = 10;
/// Files have two: the case and its step.
constexpr int bi4_most_depth = 16;
constexpr std::int32_t bi4_text = 1;

struct Bi4Type {
    std::int32_t number;
    ScalarType type;
    std::size_t components;

    std::size_t bytes() const { return components * size_of(type); }
};

std::optional<Bi4Type> bi4_type(std::int32_t number) {
    using T = ScalarType;
    static constexpr std::array types{
        Bi4Type{2, T::int32, 1},   Bi4Type{3, T::int8, 1},     Bi4Type{4, T::uint8, 1},    Bi4Type{5, T::int16, 1},
        Bi4Type{6, T::uint16, 1},  Bi4Type{7, T::int32, 1},    Bi4Type{8, T::uint32, 1},   Bi4Type{9, T::int64, 1},
        Bi4Type{10, T::uint64, 1}, Bi4Type{11, T::float32, 1}, Bi4Type{12, T::float64, 1}, Bi4Type{20, T::int32, 3},
        Bi4Type{21, T::uint32, 3}, Bi4Type{22, T::float32, 3}, Bi4Type{23, T::float64, 3},
    };
    for (const Bi4Type& type : types)
        if (type.number == number) return type;
    return std::nullopt;
}

struct Bi4Array {
    std::string_view name;
    std::optional<Bi4Type> type;  ///< none: texts
    std::size_t count = 0;
    std::string_view bytes;
};

/// The file's description of a step.
class Bi4File {
public:
    Bi4File(const std::string& name, std::string_view bytes) : in_(name, bytes) {
        if (!bytes.starts_with(bi4_title)) in_.fail("not a file of DualSPHysics: it does not begin with '#FileJBD'");
        const std::string_view header = in_.take(bi4_header_bytes);
        const int order = static_cast<unsigned char>(header[bi4_order_byte]);
        wide_ = order >= bi4_wide_sizes;
        const int endian = wide_ ? order - bi4_wide_sizes : order;
        if (endian > 1)
            in_.fail("byte " + std::to_string(bi4_order_byte) + ", the byte order, is " + std::to_string(order) +
                     ", none of 0, 1, 10 and 11");
        order_ = endian == 1 ? std::endian::big : std::endian::little;
        read_item(0);
        if (arrays_.empty()) in_.fail("has no array Pos or Posd");
    }

    const ByteCursor& at() const { return in_; }
    std::endian order() const { return order_; }
    const std::vector<Bi4Array>& arrays() const { return arrays_; }
    const Bi4Array* find(std::string_view name) const { return find_in(arrays_, name); }
    /// Ids below are of walls and bodies.
    double first_fluid_id() const { return first_fluid_id_; }

private:
    static const Bi4Array* find_in(const std::vector<Bi4Array>& arrays, std::string_view name) {
        for (const Bi4Array& array : arrays)
            if (array.name == name) return &array;
        return nullptr;
    }

    std::uint32_t number() { return load<std::uint32_t>(in_.take(sizeof(std::uint32_t)).data(), order_); }
    std::uint64_t size() {
        return wide_ ? load<std::uint64_t>(in_.take(sizeof(std::uint64_t)).data(), order_) : number();
    }
    std::string_view text() { return in_.take(number()); }
    void expect_text(std::string_view mark) {
        const std::size_t place = in_.position();
        if (const std::string_view found = text(); found != mark)
            in_.fail("damaged at byte " + std::to_string(place) + ": " + quoted(found) + " where " + quoted(mark) +
                     " begins the next part");
    }

    void read_item(int depth) {
        if (depth == bi4_most_depth)
            in_.fail("has items within items more than " + std::to_string(bi4_most_depth) + " deep");
        number();  // bytes of the item's description, which has this number itself
        expect_text("\nITEM\n");
        text();    // name
        number();  // whether the item is hidden
        number();  // whether its values are
        text();    // how float32 is printed
        text();    // how float64 is
        const std::uint32_t arrays = number();
        const std::uint32_t items = number();
        if (number() != 0) read_values();
        std::vector<Bi4Array> found;
        for (std::uint32_t i = 0; i < arrays; ++i) found.push_back(read_array());
        if (find_in(found, "Pos") != nullptr || find_in(found, "Posd") != nullptr) {
            if (!arrays_.empty()) in_.fail("has several steps; one is read: give it a file of its own");
            arrays_ = std::move(found);
        }
        for (std::uint32_t i = 0; i < items; ++i) read_item(depth + 1);
    }

    void read_values() {
        expect_text("\nVALUES");
        for (std::uint32_t left = number(); left > 0; --left) {
            const std::string_view name = text();
            const auto number_of_type = static_cast<std::int32_t>(number());
            if (number_of_type == bi4_text) {
                text();
                continue;
            }
            const auto type = bi4_type(number_of_type);
            if (!type) in_.fail("value " + quoted(name) + " has the unknown type " + std::to_string(number_of_type));
            const double value = load_scalar(type->type, in_.take(type->bytes()).data(), order_);
            if (name == "CaseNfixed" || name == "CaseNmoving" || name == "CaseNfloat") first_fluid_id_ += value;
            if (name == "Npiece" && value > 1)
                in_.fail("is one of several pieces of a step; steps in one piece are read");
        }
    }

    Bi4Array read_array() {
        number();  // bytes of the description
        expect_text("\nARRAY");
        Bi4Array array;
        array.name = text();
        number();  // hidden
        const auto number_of_type = static_cast<std::int32_t>(number());
        array.type = bi4_type(number_of_type);
        if (!array.type && number_of_type != bi4_text)
            in_.fail("array " + quoted(array.name) + " has the unknown type " + std::to_string(number_of_type));
        const std::uint64_t count = size();
        const std::uint64_t bytes = size();
        if (array.type) {
            in_.expect(count, array.type->bytes(), "values of array " + quoted(array.name));
            if (bytes != count * array.type->bytes())
                in_.fail("array " + quoted(array.name) + " has " + std::to_string(count) + " values of " +
                         std::to_string(array.type->bytes()) + " bytes in " + std::to_string(bytes) + " bytes");
        }
        array.count = count;
        array.bytes = in_.take(bytes);
        return array;
    }

    ByteCursor in_;
    std::endian order_ = std::endian::little;
    bool wide_ = false;
    std::vector<Bi4Array> arrays_;  ///< of the item that has positions
    double first_fluid_id_ = 0.0;
};

/// Which rows are particles of the fluid.
std::vector<std::size_t> fluid_rows(const Bi4File& file, std::size_t count) {
    const Bi4Array* ids = file.find("Idp") != nullptr ? file.find("Idp") : file.find("Idpd");
    const bool known = ids != nullptr && ids->type && ids->type->components == 1 && ids->count == count;
    std::vector<std::size_t> rows;
    rows.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        if (!known || load_scalar(ids->type->type, ids->bytes.data() + i * ids->type->bytes(), file.order()) >=
                          file.first_fluid_id())
            rows.push_back(i);
    return rows;
}

std::string_view usual_name(std::string_view name) {
    if (name == "Vel") return "velocity";
    if (name == "Rhop") return "density";
    if (name == "Idp" || name == "Idpd") return "id";
    return name;
}

}  // namespace

Particles read_bi4(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    const Bi4File file(name, bytes);
    ReadBudget budget(limits, bytes.size(), file.at());
    const Bi4Array& place = *(file.find("Posd") != nullptr ? file.find("Posd") : file.find("Pos"));
    if (!place.type || place.type->components != 3 || is_integer(place.type->type))
        file.at().fail("array " + quoted(place.name) + " has no three coordinates a particle");
    // The rows' numbers, and coordinates with their remainders.
    budget.take((sizeof(std::size_t) + 6 * sizeof(float)) * place.count, file.at(), "the particles");
    const std::vector<std::size_t> rows = fluid_rows(file, place.count);
    const auto number = [&](const Bi4Array& array, std::size_t row, std::size_t component) {
        return load_scalar(array.type->type,
                           array.bytes.data() + row * array.type->bytes() + component * size_of(array.type->type),
                           file.order());
    };

    Particles particles;
    particles.positions.reserve(3 * rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            set_coordinate(particles, particles.positions.size(), number(place, rows[i], axis), file.at());

    ArrayCollector collector(file.at());
    for (const Bi4Array& array : file.arrays()) {
        if (array.name == "Pos" || array.name == "Posd") continue;
        if (!array.type) {
            collector.leave_out(array.name, "texts");
        } else if (array.count != place.count) {
            collector.leave_out(
                array.name, std::to_string(array.count) + " values for " + std::to_string(place.count) + " particles");
        } else {
            budget.take(sizeof(float) * array.type->components * array.count, file.at(), "array " + quoted(array.name));
            ArrayBuilder values(usual_name(array.name), array.type->type, array.type->components, rows.size());
            for (std::size_t i = 0; i < rows.size() && values.wanted(); ++i)
                for (std::size_t c = 0; c < array.type->components; ++c) values.add(number(array, rows[i], c));
            collector.add(std::move(values));
        }
    }
    collector.finish(particles.arrays, particles.left_out);
    return particles;
}

}  // namespace meniscus::formats
