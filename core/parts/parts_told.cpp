#include "parts/parts_told.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "parts/message.hpp"

namespace meniscus {

void PartsTold::take(std::uint64_t part, const MadePart& figures, const std::vector<Seam>& its_seams, const Mesh& mesh,
                     const BrickBox& own) {
    std::erase_if(seams, [part](const PartSeam& seam) { return seam.part == part; });
    std::erase_if(made, [part](const MadePart& other) { return other.number == part; });
    std::erase_if(border, [part](const BorderVertex& vertex) { return vertex.part == part; });
    std::erase_if(ranges, [part](const PartRange& range) { return range.part == part; });
    for (const Seam& seam : its_seams) seams.push_back({seam, part});
    made.push_back(figures);
    for (const LatticePosition& place : border_vertices(mesh, own)) border.push_back({place, part});
    std::uint64_t attribute = 0;
    for (const AttributeRange& range : attribute_ranges(mesh)) ranges.push_back({part, attribute++, range});
}

PartExchange::Bytes PartsTold::packed() const {
    MessageWriter message;
    const auto bytes = [](const auto& values) { return sizeof(std::uint64_t) + values.size() * sizeof values[0]; };
    message.reserve(bytes(seams) + bytes(made) + bytes(border) + bytes(ranges) + 1);  // one that Agreement adds
    message.add_all(std::span<const PartSeam>(seams));
    message.add_all(std::span<const MadePart>(made));
    message.add_all(std::span<const BorderVertex>(border));
    message.add_all(std::span<const PartRange>(ranges));
    return message.take();
}

void PartsTold::add(const PartExchange::Bytes& message) {
    MessageReader reader(message);
    reader.append_to(seams);
    reader.append_to(made);
    reader.append_to(border);
    reader.append_to(ranges);
}

void PartsTold::add_seams(const PartExchange::Bytes& message, std::vector<PartSeam>& seams) {
    MessageReader(message).append_to(seams);
}

MadePart PartsTold::sum() const {
    MadePart sum;
    for (const MadePart& part : made) sum.add(part);
    return sum;
}

std::vector<std::uint64_t> PartsTold::own_vertices() const {
    std::vector<std::uint64_t> own(made.size());
    for (const MadePart& part : made) own[part.number] = part.vertices;
    std::vector<BorderVertex> all = border;
    std::sort(all.begin(), all.end());
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].place == all[i - 1].place) --own[all[i].part];
    return own;
}

std::vector<AttributeRange> PartsTold::whole_ranges() const {
    std::vector<AttributeRange> whole;
    for (const PartRange& one : ranges) {
        if (one.attribute >= whole.size()) whole.resize(one.attribute + 1, one.range);
        AttributeRange& range = whole[one.attribute];
        for (std::size_t c = 0; c < max_attribute_components; ++c) {
            range.minimum[c] = std::min(range.minimum[c], one.range.minimum[c]);
            range.maximum[c] = std::max(range.maximum[c], one.range.maximum[c]);
        }
    }
    return whole;
}

}  // namespace meniscus
