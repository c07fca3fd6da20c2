// Legacy VTK (vtk.org, "VTK File Formats", the simple legacy formats), versions up to 5.1: points, their arrays, and
// the faces of a mesh. Everything else in the file is walked over with its size checked, so that a truncated file never
// passes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/face_index.hpp"
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {
namespace {

/// Memory of a point, as float64 and as the float32 and remainders of particles.
constexpr std::size_t point_bytes = sizeof(std::array<double, 3>) + 6 * sizeof(float);
/// Of the end of a cell's corners, and of a triangle with its cell.
constexpr std::size_t cell_bytes = sizeof(std::size_t), triangle_bytes = sizeof(Triangle) + sizeof(std::size_t);

std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return out;
}

/// A VTK type by its name in upper case; none for `bit`, `string` and unknown ones. vtkIdType is written as int32.
std::optional<ScalarType> type_by_name(std::string_view name) {
    using T = ScalarType;
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 22> types{{
        {"FLOAT", T::float32},
        {"DOUBLE", T::float64},
        {"INT", T::int32},
        {"UNSIGNED_INT", T::uint32},
        {"CHAR", T::int8},
        {"SIGNED_CHAR", T::int8},
        {"UNSIGNED_CHAR", T::uint8},
        {"SHORT", T::int16},
        {"UNSIGNED_SHORT", T::uint16},
        {"LONG", T::int64},
        {"UNSIGNED_LONG", T::uint64},
        {"VTKIDTYPE", T::int32},
        {"VTKTYPEINT64", T::int64},
        {"VTKTYPEUINT64", T::uint64},
        {"VTKTYPEINT32", T::int32},
        {"VTKTYPEUINT32", T::uint32},
        {"VTKTYPEINT8", T::int8},
        {"VTKTYPEUINT8", T::uint8},
        {"VTKTYPEINT16", T::int16},
        {"VTKTYPEUINT16", T::uint16},
        {"VTKTYPEFLOAT32", T::float32},
        {"VTKTYPEFLOAT64", T::float64},
    }};
    for (const auto& [key, type] : types)
        if (key == name) return type;
    return std::nullopt;
}

class VtkReader {
public:
    VtkReader(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use)
        : in_(name, bytes), budget_(limits, bytes.size(), in_), use_(use), out_(in_) {}

    VtkDataset read() {
        header();
        while (in_.skip_space()) section(upper(in_.word()));
        if (!has_points_) in_.fail("a VTK file without POINTS");
        if (!cell_ends_.empty()) in_.fail("CELLS without CELL_TYPES");
        return std::move(out_);
    }

private:
    void header() {
        constexpr std::string_view magic = "# vtk DataFile Version ";
        if (!in_.rest().starts_with(magic))
            in_.fail("not a legacy VTK file: it does not begin with '# vtk DataFile Version'");
        const std::string_view version = in_.line().substr(magic.size());
        const std::size_t dot = version.find('.');
        const std::size_t major = to_count(version.substr(0, dot), in_, "VTK version");
        if (major < 1 || major > 5) in_.fail("VTK version " + quoted(version) + "; 1.0 to 5.1 are read");
        offsets_ = major >= 5;
        in_.line();  // title
        const std::string encoding = upper(in_.word());
        if (encoding != "ASCII" && encoding != "BINARY") in_.fail("neither ASCII nor BINARY but " + quoted(encoding));
        binary_ = encoding == "BINARY";
    }

    void section(const std::string& keyword) {
        if (keyword == "DATASET") {
            const std::string kind = upper(in_.word());
            if (kind != "UNSTRUCTURED_GRID" && kind != "POLYDATA")
                in_.fail("DATASET " + quoted(kind) + " holds no particles; UNSTRUCTURED_GRID and POLYDATA are read");
        } else if (keyword == "POINTS") {
            points();
        } else if (keyword == "CELLS") {
            cells();
        } else if (keyword == "VERTICES" || keyword == "LINES") {
            cells_ += cells();
            append_faces([] { return std::optional<VtkCell>(); });
        } else if (keyword == "POLYGONS" || keyword == "TRIANGLE_STRIPS") {
            const std::size_t count = cells();
            out_.faces += count;
            append_faces([kind = keyword == "POLYGONS" ? VtkCell::polygon : VtkCell::strip] { return kind; });
            cells_ += count;
        } else if (keyword == "CELL_TYPES") {
            cell_types();
        } else if (keyword == "POINT_DATA") {
            attribute_count_ = in_.count("number of points");
            point_data_ = true;
            if (attribute_count_ != out_.points.size())
                in_.fail("POINT_DATA for " + std::to_string(attribute_count_) + " points, but the file has " +
                         std::to_string(out_.points.size()));
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
        begin_data(product(count, 3), type, "coordinates");
        expect_addressable(count, in_);
        out_.wide = type == ScalarType::float64;
        budget_.take(point_bytes * count, in_, "the points");
        out_.points.resize(count);
        for (auto& point : out_.points)
            for (double& x : point) x = value(type);
    }

    /// Returns how many there are; of a mesh they wait in corners_ and cell_ends_.
    std::size_t cells() {
        const std::size_t first = in_.count("number of cells");
        const std::size_t second = in_.count("size of the cell list");
        if (offsets_) in_.skip_space();
        if (!offsets_ || !upper(in_.rest().substr(0, 7)).starts_with("OFFSETS")) {
            listed_cells(first, second);
            return first;
        }
        expect_word("OFFSETS");
        const ScalarType end_type = data_type();
        begin_data(first, end_type, "offsets");
        if (use_ == VtkUse::particles) {
            walk_over(first, end_type);
        } else {
            budget_.take(cell_bytes * first, in_, "the cells");
            for (std::size_t i = 0; i < first; ++i) {
                const std::size_t end = to_end(value(end_type), second);
                if (i == 0 && end != 0) in_.fail("the first cell begins at " + std::to_string(end) + ", not at 0");
                if (i > 0) cell_ends_.push_back(end);
            }
        }
        expect_word("CONNECTIVITY");
        const ScalarType corner_type = data_type();
        if (use_ == VtkUse::particles) {
            skip(second, corner_type);
        } else {
            begin_data(second, corner_type, "corners of cells");
            budget_.take(sizeof(std::uint32_t) * second, in_, "the corners of cells");
            for (std::size_t i = 0; i < second; ++i)
                corners_.push_back(to_index(value(corner_type), out_.points.size(), in_));
        }
        return first == 0 ? 0 : first - 1;  // an offset each, and the end
    }

    /// Reads the cells of a file before version 5: for each the number of its corners, then these.
    void listed_cells(std::size_t count, std::size_t numbers) {
        constexpr ScalarType type = ScalarType::int32;
        if (use_ == VtkUse::particles) return skip(numbers, type);
        begin_data(numbers, type, "numbers of cells");
        budget_.take(sizeof(std::uint32_t) * numbers, in_, "the corners of cells");
        std::size_t left = numbers;
        for (std::size_t i = 0; i < count; ++i) {
            if (left == 0) in_.fail("its list of cells ends before cell " + std::to_string(i));
            const double corners = value(type);
            --left;
            if (!(corners >= 0.0 && corners <= static_cast<double>(left)))
                in_.fail("cell " + std::to_string(i) + " of " + std::to_string(corners) + " corners, but " +
                         std::to_string(left) + " numbers follow");
            for (auto c = static_cast<std::size_t>(std::ceil(corners)); c > 0; --c) {
                corners_.push_back(to_index(value(type), out_.points.size(), in_));
                --left;
            }
            budget_.take(cell_bytes, in_, "the cells");
            cell_ends_.push_back(corners_.size());
        }
        if (left > 0) in_.fail(std::to_string(left) + " numbers follow the last cell");
    }

    std::size_t to_end(double end, std::size_t corners) const {
        const std::size_t least = cell_ends_.empty() ? 0 : cell_ends_.back();
        if (!(end >= static_cast<double>(least) && end <= static_cast<double>(corners)))
            in_.fail("a cell ends at corner " + std::to_string(end) + " of " + std::to_string(corners));
        return static_cast<std::size_t>(end);
    }

    /// Appends the faces of the cells that wait. kind: called once for each; none: it is no face.
    template <class Kind>
    void append_faces(const Kind& kind) {
        std::vector<std::uint32_t> face;
        std::size_t begin = 0;
        for (std::size_t i = 0; i < cell_ends_.size(); ++i) {
            const std::optional<VtkCell> type = kind();
            face.assign(corners_.begin() + static_cast<std::ptrdiff_t>(begin),
                        corners_.begin() + static_cast<std::ptrdiff_t>(cell_ends_[i]));
            begin = cell_ends_[i];
            if (type && face.size() > 2) budget_.take(triangle_bytes * (face.size() - 2), in_, "the triangles");
            if (type) append_face(out_, *type, face, cells_ + i);
        }
        cell_ends_.clear();
        corners_.clear();
    }

    void cell_types() {
        const std::size_t count = in_.count("number of cell types");
        begin_data(count, ScalarType::int32, "values");
        if (use_ == VtkUse::mesh && count != cell_ends_.size())
            in_.fail(std::to_string(count) + " types for " + std::to_string(cell_ends_.size()) + " cells");
        const auto next = [&] {
            const auto kind = face_of(value(ScalarType::int32));
            if (kind) ++out_.faces;
            return kind;
        };
        if (use_ == VtkUse::mesh) return append_faces(next);
        for (std::size_t i = 0; i < count; ++i) next();
    }

    void attribute(const std::string& keyword) {
        if (keyword == "FIELD") return field();
        if (keyword == "SCALARS") return scalars();
        if (keyword == "LOOKUP_TABLE") {
            in_.word();
            return skip(product(in_.count("size of the lookup table"), 4),
                        binary_ ? ScalarType::uint8 : ScalarType::float32);
        }
        if (keyword == "COLOR_SCALARS") return color_scalars();
        std::size_t components = 0;
        if (keyword == "VECTORS" || keyword == "NORMALS") components = 3;
        if (keyword == "TENSORS") components = 9;
        if (keyword == "TENSORS6") components = 6;
        if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS") components = 1;
        if (components == 0 && keyword != "TEXTURE_COORDINATES")
            in_.fail(quoted(keyword) + " at byte " + std::to_string(in_.position() - keyword.size()) +
                     " is no keyword of a VTK file");
        const std::string_view name = in_.word();
        if (components == 0) components = in_.count("number of texture coordinates");
        const ScalarType type = data_type();
        data_array(name, components, attribute_count_, type);
    }

    /// Bytes in a binary file, numbers from 0 to 1 in an ASCII file.
    void color_scalars() {
        const std::string_view name = in_.word();
        const std::size_t components = in_.count("number of color components");
        data_array(name, components, attribute_count_, ScalarType::uint8, binary_ ? 1.0 : 255.0);
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

    /// scale: 255 for bytes that are written as numbers from 0 to 1.
    void data_array(std::string_view name, std::size_t components, std::size_t tuples, ScalarType type,
                    double scale = 1.0) {
        const std::size_t values = product(components, tuples);
        if (point_data_ && tuples != out_.points.size())
            in_.fail("point data " + quoted(name) + " has " + std::to_string(tuples) + " values for " +
                     std::to_string(out_.points.size()) + " points");
        begin_data(values, type, "values");
        if (point_data_ && components > 0) {
            if (can_be_attribute(ElementType::float32, components))
                budget_.take(sizeof(float) * values, in_, "point data " + quoted(name));
            VtkPointArray array(out_, use_, name, type, components, in_);
            if (array.wanted())
                for (std::size_t i = 0; i < values; ++i)
                    array.add(scale == 1.0 ? value(type) : std::round(scale * value(type)));
            else
                walk_over(values, type);
            return array.finish();
        }
        if (point_data_ || !is_cell_levels(use_, name, type, components)) return walk_over(values, type);
        budget_.take(values, in_, "the cells' levels");
        out_.cell_levels.resize(values);
        for (std::uint8_t& level : out_.cell_levels) level = to_cell_level(value(type));
    }

    ScalarType data_type() {
        const std::string_view name = in_.word();
        const auto type = type_by_name(upper(name));
        if (!type) in_.fail("arrays of type " + quoted(name) + " are not read");
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
        walk_over(values, type);
    }

    /// Behind begin_data().
    void walk_over(std::size_t values, ScalarType type) {
        if (binary_) {
            in_.take(values * size_of(type));
        } else {
            for (std::size_t i = 0; i < values; ++i) in_.number("value");
        }
    }

    void expect_word(std::string_view expected) {
        const std::string word = upper(in_.word());
        if (word != expected) in_.fail("expected " + std::string(expected) + ", found " + quoted(word));
    }

    std::size_t product(std::size_t a, std::size_t b) const {
        std::size_t result = 0;
        if (__builtin_mul_overflow(a, b, &result))
            in_.fail(std::to_string(a) + " x " + std::to_string(b) + " values are announced");
        return result;
    }

    static bool blank(std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; }

    ByteCursor in_;
    ReadBudget budget_;
    VtkUse use_;
    VtkDataset out_;
    std::vector<std::uint32_t> corners_;  ///< of a mesh's cells whose types are not known yet
    std::vector<std::size_t> cell_ends_;  ///< behind the corners of each
    std::size_t cells_ = 0;               ///< of a POLYDATA, so far
    bool binary_ = false;
    bool offsets_ = false;  ///< version 5 writes cells as offsets and connectivity
    bool has_points_ = false;
    bool point_data_ = false;  ///< attributes that follow belong to points
    std::size_t attribute_count_ = 0;
};

}  // namespace

VtkDataset read_legacy_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use) {
    return VtkReader(name, bytes, limits, use).read();
}

}  // namespace meniscus::formats
