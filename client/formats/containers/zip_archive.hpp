// Zip files, as far as numpy's .npz are such: members stored or deflated, also beyond 4 GiB.
//
// By hand: zlib knows no zip. libzip would copy stored members, which are read here where they lie, names neither the
// member nor its sizes in its errors, and writes 64-bit sizes only where they are needed, thus other bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"

namespace meniscus::formats {

struct ZipMember {
    std::string name;
    bool deflated = false;
    std::uint64_t size = 0;   ///< bytes once it is decompressed
    std::uint32_t crc = 0;    ///< of these
    std::string_view stored;  ///< its bytes in the file
};

/// The members, by the directory at the end of the file. What they announce to have decompressed is taken from the
/// budget. Throws by `at` for anything else, for encrypted members and other compression, and for members that share
/// bytes of the file.
std::vector<ZipMember> zip_members(const ByteCursor& at, std::string_view bytes, ReadBudget& budget);

/// A member's bytes: those in the file, or decompressed ones in `held`. Throws by `at` for damage.
std::string_view contents(const ZipMember& member, const ByteCursor& at, std::string& held);

/// Writes members, stored, atomically.
class ZipWriter {
public:
    /// Throws as AtomicFile does, here and below.
    explicit ZipWriter(const std::filesystem::path& path) : file_(path) {}

    /// A member of these parts, one behind the other.
    void add(const std::string& name, std::span<const std::string_view> parts);
    void commit();

private:
    AtomicFile file_;
    std::string directory_;
    std::uint64_t position_ = 0;
    std::uint64_t members_ = 0;
};

}  // namespace meniscus::formats
