// Legacy VTK (vtk.org, "VTK File Formats", the simple legacy formats), versions up to 5.1: the points and the `level`
// array of a point set. Everything else in the file is walked over with its size checked, so that a truncated file
// never passes.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "formats/byte_cursor.hpp"
#include "formats/particles.hpp"
#include "formats/scalar.hpp"

namespace meniscus::formats {
namespace {

std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return out;
}

/// A VTK type by its name in upper case; none for `bit`, `string` and unknown ones. vtkIdType is written as int32.
std::optional<ScalarType> type_by_name(std::string_view name) {
    using enum ScalarType;
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 16> types{{
        {"FLOAT", float32},
        {"DOUBLE", float64},
        {"INT", int32},
        {"UNSIGNED_INT", uint32},
        {"CHAR", int8},
        {"SIGNED_CHAR", int8},
        {"UNSIGNED_CHAR", uint8},
        {"SHORT", int16},
        {"UNSIGNED_SHORT", uint16},
        {"LONG", int64},
        {"UNSIGNED_LONG", uint64},
        {"VTKIDTYPE", int32},
        {"VTKTYPEINT64", int64},
        {"VTKTYPEUINT64", uint64},
        {"VTKTYPEINT32", int32},
        {"VTKTYPEUINT32", uint32},
    }};
    for (const auto& [key, type] : types)
        if (key == name) return type;
    return std::nullopt;
}

class VtkReader {
public:
    VtkReader(const std::string& name, std::string_view bytes) : in_(name, bytes) {}

    Particles read() {
        header();
        while (in_.skip_space()) section(upper(in_.word()));
        if (!has_points_) in_.fail("a VTK file without POINTS");
        if (!particles_.levels.empty() && particles_.levels.size() != particles_.count())
            in_.fail("POINT_DATA holds " + std::to_string(particles_.levels.size()) + " levels for " +
                     std::to_string(particles_.count()) + " points");
        return std::move(particles_);
    }

private:
    void header() {
        constexpr std::string_view magic = "# vtk DataFile Version ";
        if (!in_.rest().starts_with(magic))
            in_.fail("not a legacy VTK file: it does not begin with '# vtk DataFile Version'");
        const std::string_view version = in_.line().substr(magic.size());
        const std::size_t dot = version.find('.');
        const std::size_t major = to_count(version.substr(0, dot), in_, "VTK version");
        if (major < 1 || major > 5) in_.fail("VTK version " + quote(version) + "; 1.0 to 5.1 are read");
        offsets_ = major >= 5;
        in_.line();  // title
        const std::string encoding = upper(in_.word());
        if (encoding != "ASCII" && encoding != "BINARY") in_.fail("neither ASCII nor BINARY but " + quote(encoding));
        binary_ = encoding == "BINARY";
    }

    void section(const std::string& keyword) {
        if (keyword == "DATASET") {
            const std::string kind = upper(in_.word());
            if (kind != "UNSTRUCTURED_GRID" && kind != "POLYDATA")
                in_.fail("DATASET " + quote(kind) + " holds no particles; UNSTRUCTURED_GRID and POLYDATA are read");
        } else if (keyword == "POINTS") {
            points();
        } else if (keyword == "CELLS" || keyword == "VERTICES" || keyword == "LINES" || keyword == "POLYGONS" ||
                   keyword == "TRIANGLE_STRIPS") {
            const std::size_t count = cells();
            if (keyword == "POLYGONS" || keyword == "TRIANGLE_STRIPS") particles_.faces += count;
        } else if (keyword == "CELL_TYPES") {
            cell_types();
        } else if (keyword == "POINT_DATA") {
            attribute_count_ = in_.count("number of points");
            point_data_ = true;
            if (attribute_count_ != particles_.count())
                in_.fail("POINT_DATA for " + std::to_string(attribute_count_) + " points, but the file has " +
                         std::to_string(particles_.count()));
        } else if (keyword == "CELL_DATA") {
            attribute_count_ = in_.count("number of cells");
            point_data_ = false;
        } else if (keyword == "METADATA") {
            skip_metadata();
        } else {
            attribute(keyword);
        }
    }

    /// Stands behind the word METADATA; a blank line ends the block.
    void skip_metadata() {
        if (in_.remaining() > 0) in_.line();
        while (in_.remaining() > 0 && !blank(in_.line())) {
        }
    }

    void points() {
        if (has_points_) in_.fail("POINTS occurs twice");
        has_points_ = true;
        const std::size_t count = in_.count("number of points");
        const ScalarType type = data_type();
        const std::size_t values = product(count, 3);
        begin_data(values, type, "coordinates");
        particles_.positions.resize(values);
        for (std::size_t i = 0; i < values; ++i) particles_.positions[i] = to_coordinate(value(type), i / 3, in_);
    }

    /// Returns how many there are.
    std::size_t cells() {
        const std::size_t first = in_.count("number of cells");
        const std::size_t second = in_.count("size of the cell list");
        if (offsets_) in_.skip_space();
        if (!offsets_ || !upper(in_.rest().substr(0, 7)).starts_with("OFFSETS")) {
            skip(second, ScalarType::int32);
            return first;
        }
        for (const auto& [name, size] : {std::pair{"OFFSETS", first}, std::pair{"CONNECTIVITY", second}}) {
            const std::string word = upper(in_.word());
            if (word != name) in_.fail("expected " + std::string(name) + ", found " + quote(word));
            const ScalarType type = data_type();
            skip(size, type);
        }
        return first == 0 ? 0 : first - 1;  // an offset each, and the end
    }

    /// Counts the faces: polygons and strips of triangles. Points and lines are none, and volumes have other uses.
    void cell_types() {
        constexpr double triangle = 5, quadrilateral = 9;
        const std::size_t count = in_.count("number of cell types");
        begin_data(count, ScalarType::int32, "values");
        for (std::size_t i = 0; i < count; ++i) {
            const double cell = value(ScalarType::int32);
            if (cell >= triangle && cell <= quadrilateral) ++particles_.faces;
        }
    }

    void attribute(const std::string& keyword) {
        if (keyword == "FIELD") return field();
        if (keyword == "SCALARS") return scalars();
        if (keyword == "LOOKUP_TABLE") {
            in_.word();
            return skip(product(in_.count("size of the lookup table"), 4),
                        binary_ ? ScalarType::uint8 : ScalarType::float32);
        }
        if (keyword == "COLOR_SCALARS") {
            in_.word();
            const std::size_t components = in_.count("number of color components");
            return skip(product(attribute_count_, components), binary_ ? ScalarType::uint8 : ScalarType::float32);
        }
        std::size_t components = 0;
        if (keyword == "VECTORS" || keyword == "NORMALS") components = 3;
        if (keyword == "TENSORS") components = 9;
        if (keyword == "TENSORS6") components = 6;
        if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS") components = 1;
        if (components == 0 && keyword != "TEXTURE_COORDINATES")
            in_.fail(quote(keyword) + " at byte " + std::to_string(in_.position() - keyword.size()) +
                     " is no keyword of a VTK file");
        in_.word();  // name
        if (components == 0) components = in_.count("number of texture coordinates");
        const ScalarType type = data_type();
        skip(product(attribute_count_, components), type);
    }

    void scalars() {
        const std::string_view name = in_.word();
        const ScalarType type = data_type();
        // "SCALARS name type [components]", then perhaps "LOOKUP_TABLE name": both optional, so the lines' ends count.
        const std::string_view rest = in_.rest();
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::size_t components = blank(rest.substr(0, end)) ? 1 : in_.count("number of components");
        if (upper(rest.substr(end, 13)) == "\nLOOKUP_TABLE") {
            in_.word();
            in_.word();
        }
        data_array(name, components, attribute_count_, type);
    }

    void field() {
        in_.word();  // name
        const std::size_t arrays = in_.count("number of arrays");
        for (std::size_t i = 0; i < arrays; ++i) {
            std::string_view name = in_.word();
            if (upper(name) == "METADATA") {  // may follow any array
                skip_metadata();
                name = in_.word();
            }
            const std::size_t components = in_.count("number of components");
            const std::size_t tuples = in_.count("number of tuples");
            const ScalarType type = data_type();
            data_array(name, components, tuples, type);
        }
    }

    void data_array(std::string_view name, std::size_t components, std::size_t tuples, ScalarType type) {
        if (!point_data_ || name != "level" || components != 1 || !is_integer(type))
            return skip(product(components, tuples), type);
        begin_data(tuples, type, "levels");
        particles_.levels.resize(tuples);
        for (std::size_t i = 0; i < tuples; ++i) particles_.levels[i] = to_level(value(type), i, in_);
    }

    ScalarType data_type() {
        const std::string_view name = in_.word();
        const auto type = type_by_name(upper(name));
        if (!type) in_.fail("arrays of type " + quote(name) + " are not read");
        return *type;
    }

    /// Stands on the first byte of `values` numbers afterwards, and knows that they can be there.
    void begin_data(std::size_t values, ScalarType type, std::string_view what) {
        if (binary_) {
            if (in_.remaining() > 0) in_.line();  // binary data begins on the line after its header
            in_.expect(values, size_of(type), what);
        } else {
            in_.expect(values / 2, 2, what);  // a digit and a separator each, but for the last
        }
    }

    double value(ScalarType type) {
        if (!binary_) return in_.number("value");
        return load_scalar(type, in_.take(size_of(type)).data(), std::endian::big);
    }

    void skip(std::size_t values, ScalarType type) {
        begin_data(values, type, "values");
        if (binary_) {
            in_.take(values * size_of(type));
        } else {
            for (std::size_t i = 0; i < values; ++i) in_.number("value");
        }
    }

    std::size_t product(std::size_t a, std::size_t b) const {
        std::size_t result = 0;
        if (__builtin_mul_overflow(a, b, &result))
            in_.fail(std::to_string(a) + " x " + std::to_string(b) + " values are announced");
        return result;
    }

    static bool blank(std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; }

    ByteCursor in_;
    Particles particles_;
    bool binary_ = false;
    bool offsets_ = false;  ///< version 5 writes cells as offsets and connectivity
    bool has_points_ = false;
    bool point_data_ = false;  ///< attributes that follow belong to points
    std::size_t attribute_count_ = 0;
};

}  // namespace

Particles read_vtk(const std::string& name, std::string_view bytes) {
    return VtkReader(name, bytes).read();
}

}  // namespace meniscus::formats
