#include "codec/lattice/entropy.hpp"

#include <algorithm>

#include "codec/lattice/entropy_offsets.hpp"
#include "codec/lattice/entropy_signs.hpp"
#include "codec/lattice/entropy_tables.hpp"

namespace meniscus {
namespace {

/// Whether a brick has bits that are sent as they are, beside its attributes.
bool has_raw_bits(int offset_bits, int normal_bits) {
    return offset_bits > most_coded_bits || normal_bits != 0;
}

/// An offset of more bits than the coder's, in two parts. The upper is an offset, too, and so is not 0.
struct SplitOffset {
    std::uint8_t upper;
    std::uint8_t lower;
    int lower_bits;

    static int bits(std::uint8_t upper, int dropped) { return upper == 1 ? dropped + 1 : dropped; }
    SplitOffset(std::uint8_t offset, int dropped)
        : upper(static_cast<std::uint8_t>(std::max(1, offset >> dropped))), lower_bits(bits(upper, dropped)) {
        lower = static_cast<std::uint8_t>(offset & ((1 << lower_bits) - 1));
    }
    /// lower: bits(upper, dropped) of it.
    static std::uint8_t joined(std::uint8_t upper, int dropped, std::uint64_t lower) {
        return static_cast<std::uint8_t>(upper == 1 ? lower : std::uint64_t{upper} << dropped | lower);
    }
};

void append_number(std::size_t number, std::vector<std::byte>& out) {
    for (; number >= 128; number >>= 7) out.push_back(static_cast<std::byte>(number & 127) | std::byte{128});
    out.push_back(static_cast<std::byte>(number));
}

}  // namespace

struct EntropyWriter::Memory {
    RansEncoder coder;
    SignCoder<RansEncoder> sign_coder{coder, entropy_tables};
    OffsetCoder<RansEncoder> offset_coder{coder, entropy_tables};
    std::vector<std::uint8_t> offsets;
    std::vector<PredictedNormal> normals;
    NormalIndex normal_index{entropy_tables.normals};
    BitWriter raw;
};

EntropyWriter::EntropyWriter() : memory_(std::make_unique<Memory>()) {}
EntropyWriter::~EntropyWriter() = default;

void EntropyWriter::write(LatticeBrick& brick, std::vector<std::byte>& out) {
    BrickLattice& lattice = brick.lattice;
    RansEncoder& coder = memory_->coder;
    BitWriter& raw = memory_->raw;
    const int level = lattice.only_level();
    const BrickHeader header{.has_entropy = true,
                             .has_one_level = level != 0,
                             .offset_bits = brick.offset_bits,
                             .normal_bits = brick.normal_bits};
    for (const std::byte byte : header.bytes()) out.push_back(byte);
    coder.clear();
    raw.clear();
    coder.reserve(1);
    if (level != 0) coder.code(entropy_tables.only_level, 0, level - 1);
    code_cells(coder, entropy_tables, lattice, level);
    memory_->sign_coder.run(lattice);
    code_coarser_faces(coder, entropy_tables, lattice);
    const int dropped = brick.offset_bits - most_coded_bits;
    if (dropped <= 0) {
        memory_->offset_coder.run(lattice, brick.offset_bits, brick.offsets);
    } else {
        memory_->offsets.clear();
        raw.reserve(static_cast<std::size_t>(dropped + 1) * brick.offsets.size());
        for (const std::uint8_t offset : brick.offsets) {
            const SplitOffset split(offset, dropped);
            memory_->offsets.push_back(split.upper);
            raw.put(split.lower, split.lower_bits);
        }
        memory_->offset_coder.run(lattice, most_coded_bits, memory_->offsets);
    }
    if (brick.normal_bits != 0) {
        // Of each number how far it lies beyond the outermost symbol, and its lowest bits.
        raw.reserve(static_cast<std::size_t>(4 * brick.normal_bits) * brick.normals.size());
        const auto put = [&raw](std::uint32_t value, int bits) {
            raw.put(value, bits);
            return static_cast<int>(value);
        };
        code_normals(coder, entropy_tables, memory_->normal_index, put, memory_->normals, brick);
    }
    if (has_raw_bits(brick.offset_bits, brick.normal_bits)) {
        append_number(raw.byte_count(), out);
        raw.append_to(out);
    }
    for (const std::vector<std::byte>& values : brick.attributes) out.insert(out.end(), values.begin(), values.end());
    coder.append_to(out);
}

struct EntropyReader::Memory {
    RansDecoder coder;
    SignCoder<RansDecoder> sign_coder{coder, entropy_tables};
    OffsetCoder<RansDecoder> offset_coder{coder, entropy_tables};
    std::vector<PredictedNormal> normals;
    NormalIndex normal_index{entropy_tables.normals};
    BitReader raw{std::span<const std::byte>{}};
};

EntropyReader::EntropyReader() : memory_(std::make_unique<Memory>()) {}
EntropyReader::~EntropyReader() = default;

const char* EntropyReader::read_geometry(const BrickHeader& header, std::span<const std::byte> bytes,
                                         const AnnouncedBrick& announced, LatticeBrick& brick) {
    BrickLattice& lattice = brick.lattice;
    RansDecoder& coder = memory_->coder;
    brick.offset_bits = header.offset_bits;
    brick.normal_bits = header.normal_bits;
    std::size_t raw_bytes = 0;
    if (has_raw_bits(header.offset_bits, header.normal_bits)) {
        unsigned last = 128;
        for (int shift = 0; last >= 128; shift += 7) {
            if (bytes.empty() || shift > 28) return "has no length of its raw bits";
            last = std::to_integer<unsigned>(bytes[0]);
            raw_bytes |= std::size_t{last & 127} << shift;
            bytes = bytes.subspan(1);
        }
    }
    if (raw_bytes > bytes.size()) return "ends within its raw bits";
    memory_->raw = BitReader(bytes.first(raw_bytes));
    bytes = bytes.subspan(raw_bytes);
    std::size_t attribute_bytes = 0;
    for (const std::size_t size : announced.attribute_bytes) attribute_bytes += announced.vertices * size;
    if (attribute_bytes > bytes.size()) return "ends within its attributes";
    if (const char* fault = read_attributes(bytes.first(attribute_bytes), announced, brick)) return fault;
    if (!coder.start(bytes.subspan(attribute_bytes))) return "ends within its symbols";

    const int level = header.has_one_level ? coder.code(entropy_tables.only_level, 0, 0) + 1 : 0;
    if (level > 3) return "has cells of a level that this version does not know";
    if (code_cells(coder, entropy_tables, lattice, level) > 3)
        return "has a cell of a level that this version does not know";
    if (lattice.cells().empty()) return "has no cell that draws";
    lattice.list_blocks();
    memory_->sign_coder.run(lattice);
    if (!lattice.is_drawable()) return "has a cell that draws nothing, or levels that jump";
    lattice.find_coarser_faces();
    code_coarser_faces(coder, entropy_tables, lattice);
    if (announced.triangles > lattice.most_triangles()) return "announces more triangles than its cells have";
    const int dropped = std::max(0, header.offset_bits - most_coded_bits);
    memory_->offset_coder.run(lattice, header.offset_bits - dropped, brick.offsets);
    if (coder.has_run_over()) return "ends within its symbols";
    if (brick.offsets.size() != announced.vertices) return "has another number of vertices than was announced";
    if (dropped != 0)
        for (std::uint8_t& offset : brick.offsets) {
            offset = SplitOffset::joined(offset, dropped, memory_->raw.get_some(SplitOffset::bits(offset, dropped)));
            if (offset == 0) return "has a vertex at the end of its edge";
        }
    return nullptr;
}

const char* EntropyReader::read_values(LatticeBrick& brick) {
    BitReader& raw = memory_->raw;
    if (brick.normal_bits != 0) {
        const auto get = [&raw](std::uint32_t, int bits) { return static_cast<int>(raw.get_some(bits)); };
        code_normals(memory_->coder, entropy_tables, memory_->normal_index, get, memory_->normals, brick);
    }
    if (!raw.is_good() || raw.bits_left() >= 8) return "has raw bits that do not fit";
    return memory_->coder.is_at_end() ? nullptr : "has symbols that do not fit";
}

}  // namespace meniscus
