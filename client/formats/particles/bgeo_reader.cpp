// Houdini's classic binary geometry (.bgeo, version 5), as Partio and SPlisHSPlasH write it, gzipped or not: the points
// and their attributes. The order, all big-endian: a header of counts, the attributes' definitions, then the rows of
// the points (x y z w, then their attributes). What follows, primitives for instance, is not read.
#include <array>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/inflate.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {
namespace {

constexpr std::string_view magic = "BgeoV";
constexpr std::string_view gzip_magic = "\x1f\x8b";
constexpr std::int32_t version = 5;
/// More than any program defines: definitions are small, so that their memory is.
constexpr std::int32_t most_attributes = 4096;
constexpr std::int32_t most_strings = 1'000'000;  ///< of all attributes together, as a string may take no byte
constexpr std::size_t number_bytes = 4;

/// The file from its beginning on, decompressed as far as it has been read.
class Bytes {
public:
    /// budget: what is decompressed is taken from it.
    Bytes(const ByteCursor& at, std::string_view file, ReadBudget& budget) : at_(at), budget_(budget), whole_(file) {
        if (!file.starts_with(gzip_magic)) return;
        inflater_.emplace(at, file, Deflate::gzip, "the gzipped file");
        whole_ = {};
    }

    std::size_t position() const { return position_; }
    /// Throws unless `size` bytes follow. The view holds until the next call.
    std::string_view take(std::uint64_t size, std::string_view what) {
        if (inflater_ && inflated_.size() < position_ + size) {
            budget_.take(position_ + size - inflated_.size(), at_, what);
            inflater_->extend(inflated_, position_ + size);
            whole_ = inflated_;
        }
        if (whole_.size() - position_ < size)
            at_.fail("truncated: " + std::string(what) + " at byte " + std::to_string(position_) + " has " +
                     std::to_string(size) + " bytes, but only " + std::to_string(whole_.size() - position_) +
                     " follow");
        const std::string_view taken = whole_.substr(position_, static_cast<std::size_t>(size));
        position_ += static_cast<std::size_t>(size);
        return taken;
    }
    std::int32_t number(std::string_view what) {
        return load<std::int32_t>(take(number_bytes, what).data(), std::endian::big);
    }
    std::size_t length(std::string_view what) { return load<std::uint16_t>(take(2, what).data(), std::endian::big); }
    std::string text(std::string_view what) { return std::string(take(length(what), what)); }
    std::int32_t count(std::string_view what) {
        const std::int32_t count = number(what);
        if (count < 0) at_.fail("the " + std::string(what) + " is " + std::to_string(count) + ", must be at least 0");
        return count;
    }

private:
    const ByteCursor& at_;
    ReadBudget& budget_;
    std::string_view whole_;
    std::string inflated_;
    std::optional<Inflater> inflater_;
    std::size_t position_ = 0;
};

/// An attribute of the points: `size` numbers of four bytes.
struct Attribute {
    std::string name;
    std::size_t size = 0;
    std::optional<ScalarType> type;  ///< none: names of strings, which are no values
};

/// strings: of the attributes before; those of this one are added.
Attribute read_attribute(Bytes& in, const ByteCursor& at, std::int32_t& strings) {
    enum Kind : std::int32_t { real = 0, integer = 1, text = 2, string_index = 4, vector = 5 };
    Attribute attribute;
    attribute.name = in.text("name of an attribute");
    attribute.size = in.length("size of an attribute");
    const std::int32_t kind = in.number("type of an attribute");
    switch (kind) {
        case real:
        case vector:
            attribute.type = ScalarType::float32;
            break;
        case integer:
            attribute.type = ScalarType::int32;
            break;
        case string_index: {
            const std::int32_t count = in.count("number of strings");
            if (count > most_strings - strings)
                at.fail("attribute " + quoted(attribute.name) + " has " + std::to_string(count) + " strings; at most " +
                        std::to_string(most_strings) + " are read of all attributes");
            strings += count;
            for (std::int32_t i = 0; i < count; ++i) in.text("a string");
            return attribute;
        }
        default:
            at.fail("attribute " + quoted(attribute.name) + " has type " + std::to_string(kind) +
                    "; 0 (float), 1 (int), 4 (index of a string) and 5 (vector) are read");
    }
    in.take(number_bytes * attribute.size, "default of an attribute");
    return attribute;
}

struct Header {
    std::size_t points = 0;
    std::vector<Attribute> attributes;
    std::size_t row_numbers = 4;  ///< of one point
};

Header read_header(Bytes& in, const ByteCursor& at) {
    if (in.take(magic.size(), "the beginning") != magic)
        at.fail(
            "not a classic BGEO file: it does not begin with 'BgeoV' (Houdini 12 and newer write another format: "
            "save as .bhclassic)");
    if (const std::int32_t found = in.number("version"); found != version)
        at.fail("BGEO version " + std::to_string(found) + "; " + std::to_string(version) + " is read");
    Header header;
    header.points = static_cast<std::size_t>(in.count("number of points"));
    for (const char* other : {"number of primitives", "number of point groups", "number of primitive groups"})
        in.count(other);
    const std::int32_t attributes = in.count("number of point attributes");
    for (const char* other : {"number of vertex attributes", "number of primitive attributes", "number of attributes"})
        in.count(other);
    if (attributes > most_attributes)
        at.fail("has " + std::to_string(attributes) + " point attributes, at most " + std::to_string(most_attributes) +
                " are read");
    std::int32_t strings = 0;
    for (std::int32_t i = 0; i < attributes; ++i) {
        header.attributes.push_back(read_attribute(in, at, strings));
        header.row_numbers += header.attributes.back().size;
    }
    return header;
}

}  // namespace

Particles read_bgeo(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    const ByteCursor at(name, bytes);
    ReadBudget budget(limits, bytes.size(), at);
    Bytes in(at, bytes, budget);
    const Header header = read_header(in, at);
    const std::uint64_t row_bytes = number_bytes * header.row_numbers;
    // The memory for the rows' numbers.
    budget.take(row_bytes * header.points, at, "what the points announce");
    const std::string_view rows = in.take(row_bytes * header.points, "the points");

    Particles particles;
    particles.positions.resize(3 * header.points);
    for (std::size_t i = 0; i < header.points; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            particles.positions[3 * i + axis] =
                load<float>(rows.data() + i * row_bytes + number_bytes * axis, std::endian::big);

    ArrayCollector collector(at);
    std::size_t begin = 4 * number_bytes;
    for (const Attribute& attribute : header.attributes) {
        if (attribute.type) {
            ArrayBuilder values(attribute.name, *attribute.type, attribute.size, header.points);
            for (std::size_t i = 0; i < header.points && values.wanted(); ++i)
                for (std::size_t c = 0; c < attribute.size; ++c)
                    values.add(load_scalar(*attribute.type, rows.data() + i * row_bytes + begin + number_bytes * c,
                                           std::endian::big));
            collector.add(std::move(values));
        } else {
            collector.leave_out(attribute.name, "strings");
        }
        begin += number_bytes * attribute.size;
    }
    collector.finish(particles.arrays, particles.left_out);
    return particles;
}

}  // namespace meniscus::formats
