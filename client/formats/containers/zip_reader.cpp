// PKWARE's APPNOTE.TXT, "Overall .ZIP file format".
#include <algorithm>
#include <bit>
#include <optional>

#include "formats/bytes/deflate.hpp"
#include "formats/bytes/inflate.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/zip_archive.hpp"

namespace meniscus::formats {
namespace {

constexpr std::string_view local_mark{"PK\3\4", 4}, entry_mark{"PK\1\2", 4}, end_mark{"PK\5\6", 4},
    wide_end_mark{"PK\6\6", 4}, wide_locator_mark{"PK\6\7", 4};
constexpr std::size_t local_bytes = 30, entry_bytes = 46, end_bytes = 22, wide_end_bytes = 56, wide_locator_bytes = 20;
constexpr std::size_t most_members = 4096;
constexpr unsigned deflate_method = 8;
constexpr std::uint32_t elsewhere = 0xFFFFFFFF;  ///< the number is in the field of 64-bit numbers

template <class T>
T number_at(std::string_view bytes, std::size_t place) {
    return load<T>(bytes.data() + place, std::endian::little);
}

/// Bytes [first, first + size) of the file.
std::string_view piece_of(std::string_view bytes, std::uint64_t first, std::uint64_t size, const ByteCursor& at,
                          std::string_view what) {
    if (first > bytes.size() || size > bytes.size() - first)
        at.fail("truncated: " + std::string(what) + " of " + std::to_string(size) + " bytes at byte " +
                std::to_string(first) + ", but the file has " + std::to_string(bytes.size()));
    return bytes.substr(first, size);
}

struct Directory {
    std::uint64_t first = 0;
    std::uint64_t size = 0;
};

Directory find_directory(const ByteCursor& at, std::string_view bytes) {
    constexpr std::size_t most_comment = 0xFFFF;
    const std::string_view tail = bytes.substr(bytes.size() - std::min(bytes.size(), end_bytes + most_comment));
    const std::size_t place = tail.rfind(end_mark);
    if (place == std::string_view::npos || tail.size() - place < end_bytes)
        at.fail("no zip file: it has no directory at its end");
    const std::size_t end = bytes.size() - tail.size() + place;
    Directory out{number_at<std::uint32_t>(bytes, end + 16), number_at<std::uint32_t>(bytes, end + 12)};
    if (end < wide_locator_bytes || bytes.substr(end - wide_locator_bytes, 4) != wide_locator_mark) return out;
    const auto wide = piece_of(bytes, number_at<std::uint64_t>(bytes, end - wide_locator_bytes + 8), wide_end_bytes, at,
                               "its zip64 directory");
    if (!wide.starts_with(wide_end_mark)) at.fail("no zip64 directory where its locator says");
    return {number_at<std::uint64_t>(wide, 48), number_at<std::uint64_t>(wide, 40)};
}

/// The numbers of 64 bits that an entry's extra fields hold, in their order.
class WideNumbers {
public:
    explicit WideNumbers(std::string_view extra) {
        while (extra.size() >= 4) {
            const std::size_t size = number_at<std::uint16_t>(extra, 2);
            if (size > extra.size() - 4) return;
            if (number_at<std::uint16_t>(extra, 0) == 1) numbers_ = extra.substr(4, size);
            extra.remove_prefix(4 + size);
        }
    }
    std::uint64_t of(std::uint32_t narrow, const ByteCursor& at) {
        if (narrow != elsewhere) return narrow;
        if (numbers_.size() < 8) at.fail("a member of the zip file lacks its 64-bit sizes");
        const auto value = number_at<std::uint64_t>(numbers_, 0);
        numbers_.remove_prefix(8);
        return value;
    }

private:
    std::string_view numbers_;
};

/// Takes one entry off the directory.
ZipMember next_member(std::string_view& directory, const ByteCursor& at, std::string_view bytes) {
    if (directory.size() < entry_bytes || !directory.starts_with(entry_mark))
        at.fail("damaged zip directory: no entry where one is due");
    const std::string_view entry = directory;
    const std::size_t name_bytes = number_at<std::uint16_t>(entry, 28), extra = number_at<std::uint16_t>(entry, 30),
                      comment = number_at<std::uint16_t>(entry, 32);
    if (entry.size() - entry_bytes < name_bytes + extra + comment)
        at.fail("damaged zip directory: an entry ends behind it");
    directory.remove_prefix(entry_bytes + name_bytes + extra + comment);
    ZipMember member;
    member.name = entry.substr(entry_bytes, name_bytes);
    const unsigned flags = number_at<std::uint16_t>(entry, 8), method = number_at<std::uint16_t>(entry, 10);
    if ((flags & 1U) != 0) at.fail("member " + quoted(member.name) + " is encrypted");
    if (method != 0 && method != deflate_method)
        at.fail("member " + quoted(member.name) + " is compressed by method " + std::to_string(method) +
                "; stored and deflated members are read");
    member.deflated = method == deflate_method;
    member.crc = number_at<std::uint32_t>(entry, 16);
    WideNumbers wide(entry.substr(entry_bytes + name_bytes, extra));
    member.size = wide.of(number_at<std::uint32_t>(entry, 24), at);
    const std::uint64_t stored = wide.of(number_at<std::uint32_t>(entry, 20), at);
    const std::uint64_t first = wide.of(number_at<std::uint32_t>(entry, 42), at);
    const std::string what = "member " + quoted(member.name);
    const auto header = piece_of(bytes, first, local_bytes, at, what);
    if (!header.starts_with(local_mark)) at.fail(what + " does not begin where the zip directory says");
    const std::size_t skipped =
        local_bytes + number_at<std::uint16_t>(header, 26) + number_at<std::uint16_t>(header, 28);
    member.stored = piece_of(bytes, first + skipped, stored, at, what);
    if (!member.deflated && member.size != stored)
        at.fail(what + " is stored, but has two sizes: " + std::to_string(member.size) + " and " +
                std::to_string(stored));
    return member;
}

/// One stream of bytes under many names would be decompressed for each of them.
void refuse_overlap(const std::vector<ZipMember>& members, const ByteCursor& at) {
    std::vector<const ZipMember*> in_order;
    for (const ZipMember& member : members)
        if (!member.stored.empty()) in_order.push_back(&member);
    std::sort(in_order.begin(), in_order.end(),
              [](const auto* a, const auto* b) { return a->stored.data() < b->stored.data(); });
    for (std::size_t i = 1; i < in_order.size(); ++i)
        if (const ZipMember& a = *in_order[i - 1], &b = *in_order[i];
            a.stored.data() + a.stored.size() > b.stored.data())
            at.fail("members " + quoted(a.name) + " and " + quoted(b.name) + " share bytes of the file");
}

}  // namespace

std::vector<ZipMember> zip_members(const ByteCursor& at, std::string_view bytes, ReadBudget& budget) {
    const Directory place = find_directory(at, bytes);
    std::string_view directory = piece_of(bytes, place.first, place.size, at, "its zip directory");
    std::vector<ZipMember> members;
    while (!directory.empty()) {
        if (members.size() == most_members)
            at.fail("a zip file of more than " + std::to_string(most_members) + " members");
        members.push_back(next_member(directory, at, bytes));
    }
    refuse_overlap(members, at);
    for (const ZipMember& member : members)
        if (member.deflated) budget.take(member.size, at, "member " + quoted(member.name));
    return members;
}

std::string_view contents(const ZipMember& member, const ByteCursor& at, std::string& held) {
    const std::string what = "member " + quoted(member.name);
    std::string_view bytes = member.stored;
    if (member.deflated) {
        if (member.size / most_deflation > member.stored.size())
            at.fail(what + ": " + std::to_string(member.size) + " bytes are announced, but only " +
                    std::to_string(member.stored.size()) + " compressed ones are there");
        held = inflate(at, member.stored, Deflate::raw, member.size, what);
        bytes = held;
    }
    if (bytes.size() != member.size)
        at.fail(what + " has " + std::to_string(bytes.size()) + " bytes decompressed, " + std::to_string(member.size) +
                " are announced");
    if (crc32(0, bytes) != member.crc) at.fail(what + " is damaged: its bytes do not have their checksum");
    return bytes;
}

}  // namespace meniscus::formats
