// VTK's XML (vtk.org, "VTK XML Formats"): unstructured grids (.vtu) and polygonal data (.vtp) of any number of pieces;
// arrays as text, as base64 or appended, with zlib's compression or none.
//
// The part before appended data is parsed by pugixml, so its elements are counted before it takes memory for them.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "formats/bytes/base64.hpp"
#include "formats/bytes/inflate.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/face_index.hpp"
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {
namespace {

/// The most '<' and '=' before the appended data: pugixml needs some 64 bytes for each.
constexpr std::size_t most_marks = 1'000'000;
/// What a compressed block takes of the budget beside its bytes: a decompression has to be begun for each, even for one
/// without bytes. VTK's blocks have 32 KiB and more.
constexpr std::uint64_t block_cost = 64;

std::optional<ScalarType> xml_type_by_name(std::string_view name) {
    using T = ScalarType;
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 10> types{{
        {"Int8", T::int8},
        {"UInt8", T::uint8},
        {"Int16", T::int16},
        {"UInt16", T::uint16},
        {"Int32", T::int32},
        {"UInt32", T::uint32},
        {"Int64", T::int64},
        {"UInt64", T::uint64},
        {"Float32", T::float32},
        {"Float64", T::float64},
    }};
    for (const auto& [key, type] : types)
        if (key == name) return type;
    return std::nullopt;
}

/// Behind the underscore of <AppendedData>.
struct Appended {
    std::string_view data;
    bool base64 = false;
};

class XmlReader {
public:
    XmlReader(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use)
        : at_(name, bytes), bytes_(bytes), budget_(limits, bytes.size(), at_), use_(use), out_(at_) {}

    VtkDataset read() {
        parse();
        const pugi::xml_node file = document_.child("VTKFile");
        if (!file) at_.fail("not a VTK XML file: it has no element VTKFile");
        header(file);
        const std::string kind = file.attribute("type").value();
        if (kind != "UnstructuredGrid" && kind != "PolyData")
            at_.fail("VTKFile of type " + quoted(kind) +
                     " holds no particles and no faces; UnstructuredGrid and PolyData are read");
        const pugi::xml_node body = file.child(kind.c_str());
        if (!body) at_.fail("VTKFile has no element " + kind);
        for (const pugi::xml_node node : body.children("Piece")) pieces_.push_back(piece(node));
        for (const Piece& p : pieces_) points(p);
        for (const Piece& p : pieces_) kind == "PolyData" ? polygons(p) : cells(p);
        point_data();
        if (use_ == VtkUse::mesh) cell_levels();
        return std::move(out_);
    }

private:
    struct Piece {
        pugi::xml_node node;
        std::string name;  ///< for messages: "piece 2"
        std::size_t points = 0;
        std::size_t cells = 0;  ///< of all kinds
        std::size_t first_point = 0;
        std::size_t first_cell = 0;
    };

    void parse() {
        const std::size_t begin = bytes_.find("<AppendedData");
        std::string_view head = bytes_.substr(0, begin);
        const auto marks = std::count_if(head.begin(), head.end(), [](char c) { return c == '<' || c == '='; });
        if (static_cast<std::size_t>(marks) > most_marks)
            at_.fail("more than " + std::to_string(most_marks) + " elements and attributes");
        budget_.take(head.size() + 64 * static_cast<std::uint64_t>(marks), at_, "its XML");
        text_ = head;
        if (begin != std::string_view::npos) {
            appended(bytes_.substr(begin));
            text_ += "</VTKFile>";
        }
        const pugi::xml_parse_result result =
            document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!result) at_.fail("no XML at byte " + std::to_string(result.offset) + ": " + result.description());
    }

    void appended(std::string_view rest) {
        const std::size_t end = rest.find('>');
        const std::size_t mark = end == std::string_view::npos ? end : rest.find_first_not_of(" \t\r\n", end + 1);
        if (mark == std::string_view::npos || rest[mark] != '_')
            at_.fail("AppendedData does not begin with an underscore");
        const std::string_view tag = rest.substr(0, end);
        const bool base64 =
            tag.find("\"base64\"") != std::string_view::npos || tag.find("'base64'") != std::string_view::npos;
        if (!base64 && tag.find("\"raw\"") == std::string_view::npos && tag.find("'raw'") == std::string_view::npos)
            at_.fail("AppendedData is encoded neither as raw nor as base64");
        rest.remove_prefix(mark + 1);
        appended_ = Appended{base64 ? rest.substr(0, rest.find('<')) : rest, base64};
    }

    void header(const pugi::xml_node& file) {
        const std::string_view order = file.attribute("byte_order").as_string("LittleEndian");
        if (order != "LittleEndian" && order != "BigEndian")
            at_.fail("byte_order " + quoted(order) + "; LittleEndian and BigEndian are read");
        order_ = order == "BigEndian" ? std::endian::big : std::endian::little;
        const std::string_view type = file.attribute("header_type").as_string("UInt32");
        if (type != "UInt32" && type != "UInt64")
            at_.fail("header_type " + quoted(type) + "; UInt32 and UInt64 are read");
        header_type_ = type == "UInt64" ? ScalarType::uint64 : ScalarType::uint32;
        compressor_ = file.attribute("compressor").value();
    }

    Piece piece(const pugi::xml_node& node) {
        Piece p;
        p.node = node;
        p.name = "piece " + std::to_string(pieces_.size() + 1);
        p.points = count(p, "NumberOfPoints");
        if (!pieces_.empty()) {
            p.first_point = pieces_.back().first_point + pieces_.back().points;
            p.first_cell = pieces_.back().first_cell + pieces_.back().cells;
        }
        constexpr std::size_t most = std::size_t{1} << 48;  // so that no sum overflows
        for (const char* kind :
             {"NumberOfCells", "NumberOfVerts", "NumberOfLines", "NumberOfPolys", "NumberOfStrips"}) {
            const std::size_t cells = node.attribute(kind) ? count(p, kind) : 0;
            if (cells > most) at_.fail(p.name + " has " + std::to_string(cells) + " cells");
            p.cells += cells;
        }
        if (p.points > most) at_.fail(p.name + " has " + std::to_string(p.points) + " points");
        expect_addressable(p.first_point + p.points, at_);
        return p;
    }

    std::size_t count(const Piece& p, const char* attribute) const {
        return to_count(p.node.attribute(attribute).value(), at_, p.name + ", " + attribute);
    }

    struct ArrayForm {
        ScalarType type = ScalarType::float32;
        std::size_t components = 1;
    };

    /// None: its type is no number's.
    std::optional<ArrayForm> form_of(const pugi::xml_node& array, const std::string& what) const {
        const auto type = xml_type_by_name(array.attribute("type").value());
        if (!type) return std::nullopt;
        const pugi::xml_attribute components = array.attribute("NumberOfComponents");
        const std::size_t number = components ? to_count(components.value(), at_, what + ", NumberOfComponents") : 1;
        return ArrayForm{*type, number};
    }

    static std::string named(const Piece& p, const pugi::xml_node& array) {
        return p.name + ", array " + quoted(array.attribute("Name").value());
    }

    /// Calls take(value) for each of `values` numbers of the array. make_room: called before the first, once it is
    /// known that they are there.
    template <class MakeRoom, class Take>
    void read(const pugi::xml_node& array, const std::string& what, ScalarType type, std::size_t values,
              const MakeRoom& make_room, const Take& take) {
        const std::string_view format = array.attribute("format").as_string("ascii");
        if (format == "ascii") {
            ByteCursor in(place(what), array.child_value());
            in.expect(values / 2, 2, "numbers");
            make_room();
            for (std::size_t i = 0; i < values; ++i) take(in.number("value"));
            if (in.skip_space()) in.fail(std::to_string(in.remaining()) + " bytes follow the last number");
            return;
        }
        std::uint64_t bytes = 0;
        if (__builtin_mul_overflow(values, size_of(type), &bytes))
            at_.fail(what + ": " + std::to_string(values) + " numbers are announced");
        std::string held;
        const std::string_view data = format == "binary"     ? encoded(array.child_value(), what, bytes, held)
                                      : format == "appended" ? from_appended(array, what, bytes, held)
                                                             : unknown_format(what, format);
        make_room();
        for (std::size_t i = 0; i < values; ++i) take(load_scalar(type, data.data() + i * size_of(type), order_));
    }

    [[noreturn]] std::string_view unknown_format(const std::string& what, std::string_view format) const {
        at_.fail(what + ": format " + quoted(format) + "; ascii, binary and appended are read");
    }

    /// The name of a cursor in an array.
    std::string place(const std::string& what) const { return at_.name() + ": " + what; }

    std::string_view from_appended(const pugi::xml_node& array, const std::string& what, std::uint64_t bytes,
                                   std::string& held) {
        if (!appended_) at_.fail(what + " is appended, but the file has no AppendedData");
        const std::size_t offset = to_count(array.attribute("offset").value(), at_, what + ", offset");
        if (offset > appended_->data.size())
            at_.fail(what + " begins at byte " + std::to_string(offset) + " of " +
                     std::to_string(appended_->data.size()) + " appended ones");
        const std::string_view data = appended_->data.substr(offset);
        if (appended_->base64) return encoded(data, what, bytes, held);
        ByteCursor in(place(what), data);
        const auto raw = [&](std::size_t size) { return in.take(size); };
        return unpacked(raw, in.remaining(), what, bytes, held);
    }

    std::string_view encoded(std::string_view text, const std::string& what, std::uint64_t bytes, std::string& held) {
        Base64Reader reader(text);
        const auto decoded = [&](std::size_t size) { return reader.take(size, at_, what); };
        return unpacked(decoded, reader.most(), what, bytes, held);
    }

    template <class TakeBytes>
    static constexpr bool is_copied = std::is_same_v<std::invoke_result_t<TakeBytes, std::size_t>, std::string>;

    /// take(size): the next bytes, as a string or a view. most: bytes that can follow. bytes: those of the array.
    /// Returns them; what is not in the file lies in `held`, and is paid for.
    template <class TakeBytes>
    std::string_view unpacked(const TakeBytes& take, std::size_t most, const std::string& what, std::uint64_t bytes,
                              std::string& held) {
        if (!compressor_.empty()) return decompressed(take, most, what, bytes, held);
        const std::uint64_t announced = header_numbers(take(size_of(header_type_)), 1)[0];
        expect_size(announced, bytes, what);
        if constexpr (is_copied<TakeBytes>) {
            budget_.take(std::min<std::uint64_t>(bytes, most), at_, what);
            held = take(bytes);
            return held;
        } else {
            return take(bytes);
        }
    }

    template <class TakeBytes>
    std::string_view decompressed(const TakeBytes& take, std::size_t most, const std::string& what, std::uint64_t bytes,
                                  std::string& held) {
        if (compressor_ != "vtkZLibDataCompressor")
            at_.fail("arrays are compressed by " + quoted(compressor_) + "; vtkZLibDataCompressor is read");
        const std::size_t word = size_of(header_type_);
        const std::uint64_t blocks = header_numbers(take(word), 1)[0];
        if (blocks > most / word)
            at_.fail(what + ": " + std::to_string(blocks) + " compressed blocks are announced, but only " +
                     std::to_string(most) + " bytes follow");
        const auto sizes = header_numbers(take(2 * word), 2);
        const auto compressed = header_numbers(take(blocks * word), blocks);
        if (blocks == 0) {
            expect_size(0, bytes, what);
            return held;
        }
        budget_.take(block_cost * blocks, at_, what + ", its compressed blocks");
        std::uint64_t all = 0;
        const std::uint64_t last = sizes[1] == 0 ? sizes[0] : sizes[1];
        if (__builtin_mul_overflow(blocks - 1, sizes[0], &all) || __builtin_add_overflow(all, last, &all))
            at_.fail(what + " announces " + std::to_string(blocks) + " blocks of " + std::to_string(sizes[0]) +
                     " bytes");
        expect_size(all, bytes, what);
        if (bytes / most_deflation > most)
            at_.fail(what + ": " + std::to_string(bytes) + " bytes are announced, but only " + std::to_string(most) +
                     " compressed ones follow");
        budget_.take(bytes, at_, what);
        held.reserve(bytes);
        for (std::uint64_t i = 0; i < blocks; ++i) {
            if (compressed[i] > most)
                at_.fail(what + ": a compressed block of " + std::to_string(compressed[i]) +
                         " bytes is announced, but only " + std::to_string(most) + " follow");
            if constexpr (is_copied<TakeBytes>) budget_.take(compressed[i], at_, what);
            const std::uint64_t size = i + 1 < blocks ? sizes[0] : last;
            const std::string block = inflate(at_, take(compressed[i]), Deflate::zlib, size, what);
            if (block.size() != size)
                at_.fail(what + ": block " + std::to_string(i) + " has " + std::to_string(block.size()) +
                         " bytes decompressed, " + std::to_string(size) + " are announced");
            held += block;
        }
        return held;
    }

    std::vector<std::uint64_t> header_numbers(std::string_view bytes, std::size_t count) const {
        std::vector<std::uint64_t> out(count);
        const std::size_t word = size_of(header_type_);
        for (std::size_t i = 0; i < count; ++i)
            out[i] = word == 8 ? load<std::uint64_t>(bytes.data() + i * word, order_)
                               : load<std::uint32_t>(bytes.data() + i * word, order_);
        return out;
    }

    void expect_size(std::uint64_t announced, std::uint64_t bytes, const std::string& what) const {
        if (announced != bytes)
            at_.fail(what + " has " + std::to_string(announced) + " bytes, not the " + std::to_string(bytes) +
                     " of its piece's size");
    }

    void points(const Piece& p) {
        const pugi::xml_node array = p.node.child("Points").child("DataArray");
        if (!array && p.points > 0) at_.fail(p.name + " has no DataArray in Points");
        if (p.points == 0) return;
        const std::string what = p.name + ", Points";
        const auto form = form_of(array, what);
        if (!form || form->components != 3)
            at_.fail(what + ": 3 components of a number are needed, not " +
                     quoted(array.attribute("NumberOfComponents").value()) + " of " +
                     quoted(array.attribute("type").value()));
        out_.wide = out_.wide || form->type == ScalarType::float64;
        std::size_t next = 3 * out_.points.size();
        read(
            array, what, form->type, 3 * p.points,
            [&] {
                // The points are kept as float64, and as the float32 and remainders of particles.
                budget_.take((sizeof(out_.points[0]) + 6 * sizeof(float)) * p.points, at_, what);
                out_.points.resize(out_.points.size() + p.points);
            },
            [&](double x) {
                out_.points[next / 3][next % 3] = x;
                ++next;
            });
    }

    static pugi::xml_node array_named(const pugi::xml_node& parent, const char* name) {
        for (const pugi::xml_node array : parent.children("DataArray"))
            if (std::string_view(array.attribute("Name").value()) == name) return array;
        return {};
    }

    /// An array of cells as numbers.
    std::vector<double> cell_numbers(const Piece& p, const pugi::xml_node& parent, const char* name,
                                     std::size_t count) {
        std::vector<double> out;
        const std::string what = p.name + ", " + parent.name() + " " + name;
        const pugi::xml_node array = array_named(parent, name);
        const auto form = array ? form_of(array, what) : std::nullopt;
        if (!form) at_.fail(what + ": such an array of numbers is needed");
        read(
            array, what, form->type, count,
            [&] {
                budget_.take(sizeof(double) * count, at_, what);
                out.reserve(count);
            },
            [&](double x) { out.push_back(x); });
        return out;
    }

    /// Appends the cells that are faces as triangles. types: empty, then all are `kind`.
    void faces(const Piece& p, const pugi::xml_node& parent, std::size_t count, std::size_t first_cell,
               const std::vector<double>& types, VtkCell kind) {
        const std::vector<double> ends = cell_numbers(p, parent, "offsets", count);
        const double last = ends.empty() ? 0.0 : ends.back();
        if (!(last >= 0.0 && last <= 1e15)) at_.fail(p.name + ": its cells end at corner " + std::to_string(last));
        const std::vector<double> numbers = cell_numbers(p, parent, "connectivity", static_cast<std::size_t>(last));
        std::size_t triangles = 0;
        double before = 0.0;
        for (const double end : ends) {
            if (!(end >= before && end <= last) || end != std::floor(end))
                at_.fail(p.name + ": a cell ends at corner " + std::to_string(end) + ", the one before at " +
                         std::to_string(before));
            triangles += end - before > 2.0 ? static_cast<std::size_t>(end - before) - 2 : 0;
            before = end;
        }
        budget_.take(triangles * (sizeof(Triangle) + sizeof(std::size_t)), at_, p.name + ", its triangles");
        std::vector<std::uint32_t> corners;
        std::size_t begin = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            corners.clear();
            const auto end = static_cast<std::size_t>(ends[i]);
            for (; begin < end; ++begin)
                corners.push_back(static_cast<std::uint32_t>(p.first_point) + to_index(numbers[begin], p.points, at_));
            const auto type = types.empty() ? std::optional(kind) : face_of(types[i]);
            if (type) append_face(out_, *type, corners, first_cell + i);
        }
    }

    void cells(const Piece& p) {
        if (p.cells == 0) return;
        const pugi::xml_node parent = p.node.child("Cells");
        const std::vector<double> types = cell_numbers(p, parent, "types", p.cells);
        out_.faces += static_cast<std::size_t>(
            std::count_if(types.begin(), types.end(), [](double type) { return face_of(type).has_value(); }));
        if (use_ == VtkUse::mesh) faces(p, parent, p.cells, p.first_cell, types, VtkCell::polygon);
    }

    /// Cells are numbered: vertices, lines, polygons, strips.
    void polygons(const Piece& p) {
        const auto number = [&](const char* kind) { return p.node.attribute(kind) ? count(p, kind) : 0; };
        const std::size_t polys = number("NumberOfPolys"), strips = number("NumberOfStrips");
        out_.faces += polys + strips;
        if (use_ != VtkUse::mesh) return;
        const std::size_t first = p.first_cell + number("NumberOfVerts") + number("NumberOfLines");
        if (polys > 0) faces(p, p.node.child("Polys"), polys, first, {}, VtkCell::polygon);
        if (strips > 0) faces(p, p.node.child("Strips"), strips, first + polys, {}, VtkCell::strip);
    }

    /// The arrays of a piece's points by their names, of which the first counts.
    struct PointData {
        const Piece* piece;
        std::unordered_map<std::string_view, pugi::xml_node> arrays;
    };

    static PointData point_data_of(const Piece& p) {
        PointData out{&p, {}};
        for (const pugi::xml_node array : p.node.child("PointData").children("DataArray"))
            out.arrays.emplace(array.attribute("Name").value(), array);
        return out;
    }

    /// The arrays of the first piece that has points; the others must have them too.
    void point_data() {
        std::vector<PointData> pieces;
        for (const Piece& p : pieces_)
            if (p.points > 0) pieces.push_back(point_data_of(p));
        if (pieces.empty()) return;
        const Piece& first = *pieces.front().piece;
        for (const pugi::xml_node array : first.node.child("PointData").children("DataArray")) {
            const char* name = array.attribute("Name").value();
            const std::string what = named(first, array);
            if (pieces.front().arrays.at(name) != array) {
                out_.arrays.leave_out(name, "the name of another array");
                continue;
            }
            const auto form = form_of(array, what);
            if (!form || form->components == 0) {
                out_.arrays.leave_out(name, "type " + quoted(array.attribute("type").value()));
                continue;
            }
            // Before memory is taken: at most 4 bytes for each number. What cannot be an attribute takes none.
            if (can_be_attribute(ElementType::float32, form->components))
                budget_.take(std::uint64_t{out_.points.size()} * form->components * 4, at_, what);
            VtkPointArray values(out_, use_, name, form->type, form->components, at_);
            if (values.wanted())
                for (const PointData& piece : pieces) piece_values(piece, name, *form, values);
            values.finish();
        }
    }

    void piece_values(const PointData& piece, const char* name, const ArrayForm& form, VtkPointArray& values) {
        const Piece& p = *piece.piece;
        const auto found = piece.arrays.find(name);
        const pugi::xml_node array = found == piece.arrays.end() ? pugi::xml_node() : found->second;
        const std::string what = named(p, array);
        const auto own = array ? form_of(array, what) : std::nullopt;
        if (!own || own->type != form.type || own->components != form.components)
            at_.fail(p.name + " has no array " + quoted(name) + " like that of the pieces before");
        read(
            array, what, form.type, p.points * form.components, [] {}, [&](double x) { values.add(x); });
    }

    void cell_levels() {
        std::size_t cells = 0;
        for (const Piece& p : pieces_) {
            const pugi::xml_node array = array_named(p.node.child("CellData"), "level");
            const std::string what = named(p, array);
            const auto form = array ? form_of(array, what) : std::nullopt;
            if (!form || !is_cell_levels(use_, "level", form->type, form->components)) return out_.cell_levels.clear();
            read(
                array, what, form->type, p.cells,
                [&] {
                    budget_.take(p.cells, at_, what);
                    out_.cell_levels.reserve(cells += p.cells);
                },
                [&](double level) { out_.cell_levels.push_back(to_cell_level(level)); });
        }
    }

    ByteCursor at_;
    std::string_view bytes_;
    ReadBudget budget_;
    VtkUse use_;
    std::string text_;  ///< pugixml's, in place
    pugi::xml_document document_;
    std::optional<Appended> appended_;
    std::endian order_ = std::endian::little;
    ScalarType header_type_ = ScalarType::uint32;
    std::string compressor_;
    std::vector<Piece> pieces_;
    VtkDataset out_;
};

}  // namespace

VtkDataset read_xml_vtk(const std::string& name, std::string_view bytes, const ReadLimits& limits, VtkUse use) {
    return XmlReader(name, bytes, limits, use).read();
}

}  // namespace meniscus::formats
