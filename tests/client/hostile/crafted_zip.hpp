// Zip files that say of their members what their maker wants.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/bytes/scalar.hpp"
#include "hostile/deflating.hpp"

namespace meniscus::test {

/// What the directory says of a member.
struct CraftedMember {
    std::string name;
    std::uint32_t size = 0;    ///< decompressed
    std::uint32_t stored = 0;  ///< compressed
    std::uint32_t crc = 0;
    std::uint32_t first = 0;  ///< of its local header
};

/// A local header and the bytes behind it.
inline std::string crafted_local(const std::string& stored) {
    std::string out = "PK\3\4";
    out.append(26, '\0');
    return out + stored;
}

inline std::string crafted_zip(std::string locals, const std::vector<CraftedMember>& members) {
    using formats::store;
    std::string directory;
    for (const CraftedMember& member : members) {
        directory += "PK\1\2";
        directory.append(6, '\0');
        store(directory, std::uint16_t{Z_DEFLATED});
        store(directory, std::uint32_t{0});
        store(directory, member.crc);
        store(directory, member.stored);
        store(directory, member.size);
        store(directory, static_cast<std::uint16_t>(member.name.size()));
        directory.append(12, '\0');
        store(directory, member.first);
        directory += member.name;
    }
    std::string end = "PK\5\6";
    end.append(4, '\0');
    for (int i = 0; i < 2; ++i) store(end, static_cast<std::uint16_t>(members.size()));
    store(end, static_cast<std::uint32_t>(directory.size()));
    store(end, static_cast<std::uint32_t>(locals.size()));
    end.append(2, '\0');
    return std::move(locals) + directory + end;
}

/// Deflated members.
inline std::string crafted_zip(const std::vector<std::pair<std::string, Deflating*>>& contents) {
    std::string locals;
    std::vector<CraftedMember> members;
    for (const auto& [name, content] : contents) {
        const std::string& stored = content->finish();
        members.push_back({name, static_cast<std::uint32_t>(content->size()), static_cast<std::uint32_t>(stored.size()),
                           content->crc(), static_cast<std::uint32_t>(locals.size())});
        locals += crafted_local(stored);
    }
    return crafted_zip(std::move(locals), members);
}
inline std::string crafted_zip(const std::string& name, Deflating& content) {
    return crafted_zip({{name, &content}});
}

}  // namespace meniscus::test
