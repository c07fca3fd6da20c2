// Where parts touch: the seams between two of them, and the vertices that both have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/part.hpp"
#include "meniscus/parts.hpp"

namespace meniscus {

/// What a part has at one that touches it.
struct Contact {
    std::vector<Seam> seams;              ///< by first, then by second
    std::vector<std::uint32_t> vertices;  ///< places in PartBorder::vertices, ascending: those on the other's box, too
};

/// A part's border.
struct PartBorder {
    std::vector<LatticePosition> vertices;     ///< of its mesh, on the faces of its box; ascending
    std::map<std::uint64_t, Contact> touches;  ///< by number, all parts whose boxes touch its own

    /// seams: of the part. own: the boxes of all parts.
    PartBorder(std::size_t part, std::span<const Seam> seams, const Mesh& mesh, std::span<const BrickBox> own);
};

/// The borders of a process's parts, by number.
using Borders = std::map<std::uint64_t, PartBorder>;

/// Writes what each part has at those of greater numbers: to[r] is the message to rank r. rank_of: each part's. The
/// memory of `to` is used again.
void write_contacts(const Borders& borders, std::span<const std::size_t> rank_of, std::vector<PartExchange::Bytes>& to);

/// Seams that differ, or that one of both parts alone has.
struct UnequalSeams {
    std::uint64_t count = 0;
    std::vector<std::size_t> parts;  ///< those on both sides of them; some several times
};

/// What a process finds of its parts and those of lesser numbers that touch them.
struct ComparedContacts {
    UnequalSeams unequal;
    std::map<std::uint64_t, std::uint64_t> repeated;  ///< of each part, vertices that one of a lesser number has, too
};
/// messages: from all ranks, by write_contacts(). Throws InvalidInput for messages of processes that do not deal alike.
ComparedContacts compare_contacts(const Borders& borders, std::span<const PartExchange::Bytes> messages);

}  // namespace meniscus
