#include "formats/bytes/deflate.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/zip_archive.hpp"

namespace meniscus::formats {
namespace {

// Sizes are always written as 64-bit numbers, so that no file needs another form.
constexpr std::uint16_t version = 45;
constexpr std::uint16_t no_date = 0, first_date = 0x21;  // midnight of 1 January 1980: equal contents, equal bytes
constexpr std::uint16_t in_utf8 = 0x800;
constexpr std::uint16_t wide_field = 1;
constexpr std::uint32_t not_here = 0xFFFFFFFF;

/// Stores the fields that a member's header and its entry in the directory share.
void store_common(std::string& out, std::uint32_t crc, const std::string& name, std::uint16_t extra_bytes) {
    for (const std::uint16_t number : {version, in_utf8, std::uint16_t{0}, no_date, first_date}) store(out, number);
    for (const std::uint32_t number : {crc, not_here, not_here}) store(out, number);
    store(out, static_cast<std::uint16_t>(name.size()));
    store(out, extra_bytes);
}

}  // namespace

void ZipWriter::add(const std::string& name, std::span<const std::string_view> parts) {
    std::uint64_t size = 0;
    std::uint32_t checksum = 0;
    for (const std::string_view part : parts) {
        checksum = crc32(checksum, part);
        size += part.size();
    }
    std::string header = "PK\3\4";
    store_common(header, checksum, name, 20);
    header += name;
    store(header, wide_field);
    store(header, std::uint16_t{16});
    store(header, size);
    store(header, size);

    directory_ += "PK\1\2";
    store(directory_, version);
    store_common(directory_, checksum, name, 28);
    for (int i = 0; i < 3; ++i) store(directory_, std::uint16_t{0});  // comment, disk, kind
    store(directory_, std::uint32_t{0});                              // permissions
    store(directory_, not_here);
    directory_ += name;
    store(directory_, wide_field);
    store(directory_, std::uint16_t{24});
    for (const std::uint64_t number : {size, size, position_}) store(directory_, number);

    file_.write(header);
    for (const std::string_view part : parts) file_.write(part);
    position_ += header.size() + size;
    ++members_;
}

void ZipWriter::commit() {
    const std::uint64_t size = directory_.size();
    std::string end = "PK\6\6";
    store(end, std::uint64_t{44});  // of the rest of this record
    store(end, version);
    store(end, version);
    store(end, std::uint64_t{0});  // disks
    for (const std::uint64_t number : {members_, members_, size, position_}) store(end, number);
    end += "PK\6\7";
    store(end, std::uint32_t{0});
    store(end, position_ + size);
    store(end, std::uint32_t{1});
    end += "PK\5\6";
    store(end, std::uint32_t{0});
    for (int i = 0; i < 2; ++i) store(end, std::uint16_t{0xFFFF});
    store(end, not_here);
    store(end, not_here);
    store(end, std::uint16_t{0});
    file_.write(directory_);
    file_.write(end);
    file_.commit();
}

}  // namespace meniscus::formats
