// A seam is equal where both of its parts have it, with the same hash.
#include "parts/contacts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "meniscus/error.hpp"
#include "particles/seams.hpp"
#include "parts/message.hpp"

namespace meniscus {
namespace {

using Units = std::array<std::int64_t, 3>;

/// A box of bricks in units of a mesh's lattice.
struct UnitBox {
    Units low{}, high{};

    UnitBox(const BrickBox& box, unsigned offset_bits) {
        const auto brick_units = static_cast<std::int64_t>(brick_cells) << offset_bits;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = box.low[axis] * brick_units;
            high[axis] = box.high[axis] * brick_units;
        }
    }
    /// With its faces.
    bool holds(const LatticePosition& v) const {
        bool holds = true;
        for (std::size_t axis = 0; axis < 3; ++axis) holds = holds && v[axis] >= low[axis] && v[axis] <= high[axis];
        return holds;
    }
    bool has_on_a_face(const LatticePosition& v) const {
        bool is_on_a_face = false;
        for (std::size_t axis = 0; axis < 3; ++axis)
            is_on_a_face = is_on_a_face || v[axis] == low[axis] || v[axis] == high[axis];
        return is_on_a_face;
    }
};

bool touch(const BrickBox& a, const BrickBox& b) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (a.high[axis] < b.low[axis] || b.high[axis] < a.low[axis]) return false;
    return true;
}

std::uint64_t count_unequal(std::span<const Seam> some, std::span<const Seam> others) {
    std::uint64_t count = 0;
    auto a = some.begin();
    auto b = others.begin();
    while (a != some.end() && b != others.end()) {
        const bool is_first = comes_before(*a, *b), is_second = comes_before(*b, *a);
        if (is_first || is_second || a->hash != b->hash) ++count;
        if (!is_second) ++a;
        if (!is_first) ++b;
    }
    return count + static_cast<std::uint64_t>((some.end() - a) + (others.end() - b));
}

}  // namespace

PartBorder::PartBorder(std::size_t part, std::span<const Seam> seams, const Mesh& mesh, std::span<const BrickBox> own) {
    const UnitBox box(own[part], mesh.offset_bits);
    for (const LatticePosition& v : mesh.vertices)
        if (box.has_on_a_face(v)) vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end());
    for (std::size_t other = 0; other < own.size(); ++other) {
        if (other == part || !touch(own[part], own[other])) continue;
        Contact& contact = touches[other];
        for (const Seam& seam : seams)
            if (own[other].holds(seam.first) || own[other].holds(seam.second)) contact.seams.push_back(seam);
        const UnitBox others_box(own[other], mesh.offset_bits);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (others_box.holds(vertices[v])) contact.vertices.push_back(static_cast<std::uint32_t>(v));
    }
}

void write_contacts(const Borders& borders, std::span<const std::size_t> rank_of,
                    std::vector<PartExchange::Bytes>& to) {
    std::vector<MessageWriter> messages;
    messages.reserve(to.size());
    for (PartExchange::Bytes& bytes : to) messages.emplace_back(std::move(bytes));
    for (const auto& [part, border] : borders)
        for (auto at = border.touches.upper_bound(part); at != border.touches.end(); ++at) {
            const auto& [other, contact] = *at;
            MessageWriter& message = messages[rank_of[other]];
            message.add(part);
            message.add(other);
            message.add_all(std::span<const Seam>(contact.seams));
            message.add_some(std::span<const LatticePosition>(border.vertices), 1, contact.vertices);
        }
    for (std::size_t rank = 0; rank < to.size(); ++rank) to[rank] = messages[rank].take();
}

ComparedContacts compare_contacts(const Borders& borders, std::span<const PartExchange::Bytes> messages) {
    ComparedContacts compared;
    std::map<std::uint64_t, std::vector<bool>> is_repeated;
    for (const auto& [part, border] : borders) is_repeated[part].resize(border.vertices.size());
    std::vector<Seam> seams;
    std::vector<LatticePosition> vertices;
    for (const PartExchange::Bytes& bytes : messages)
        for (MessageReader message(bytes); !message.is_at_end();) {
            const auto other = message.get<std::uint64_t>();
            const auto part = message.get<std::uint64_t>();
            seams.clear();
            message.append_to(seams);
            vertices.clear();
            message.append_to(vertices);
            const auto found = borders.find(part);
            if (found == borders.end() || !found->second.touches.contains(other))
                throw InvalidInput("part " + std::to_string(other) + " has been said to touch part " +
                                   std::to_string(part) +
                                   ", which is not so here: all processes of a frame must run the same version");
            const PartBorder& border = found->second;
            const Contact& contact = border.touches.at(other);
            if (const std::uint64_t unequal = count_unequal(contact.seams, seams); unequal != 0) {
                compared.unequal.count += unequal;
                compared.unequal.parts.insert(compared.unequal.parts.end(), {other, part});
            }
            auto its = vertices.begin();
            for (const std::uint32_t v : contact.vertices) {
                while (its != vertices.end() && *its < border.vertices[v]) ++its;
                if (its != vertices.end() && *its == border.vertices[v]) is_repeated[part][v] = true;
            }
        }
    for (const auto& [part, those] : is_repeated)
        compared.repeated[part] = static_cast<std::uint64_t>(std::count(those.begin(), those.end(), true));
    return compared;
}

}  // namespace meniscus
