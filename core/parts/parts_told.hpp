// What each process tells of the parts that it has made, for the comparison of seams and for the whole's figures.
#pragma once

#include <cstdint>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/parts.hpp"
#include "parts/contacts.hpp"
#include "parts/made_part.hpp"

namespace meniscus {

/// The range of an attribute over a part's vertices.
struct PartRange {
    std::uint64_t part = 0;       ///< its number
    std::uint64_t attribute = 0;  ///< its place among the mesh's
    AttributeRange range;
};

struct PartsTold {
    UnequalSeams unequal;
    std::vector<MadePart> made;
    std::vector<PartRange> ranges;

    /// A part that has been made once more takes the place of what it was.
    void take(std::uint64_t part, const MadePart& figures, const Mesh& mesh);
    /// Of the parts that were taken.
    void take(const ComparedContacts& compared);
    PartExchange::Bytes packed() const;
    /// Takes what a process tells, packed.
    void add(const PartExchange::Bytes& message);
    /// Takes of it the seams that differ alone.
    static void add_unequal(const PartExchange::Bytes& message, UnequalSeams& unequal);

    MadePart sum() const;
    /// Of each part, the vertices that no part before it has.
    std::vector<std::uint64_t> own_vertices() const;
    /// Of each attribute over all vertices; none without vertices.
    std::vector<AttributeRange> whole_ranges() const;
};

}  // namespace meniscus
