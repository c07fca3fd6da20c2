#include "parts/parts_told.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>

#include "parts/message.hpp"

namespace meniscus {
namespace {

void add_unequal(MessageReader& message, UnequalSeams& unequal) {
    unequal.count += message.get<std::uint64_t>();
    message.append_to(unequal.parts);
}

std::uint64_t farthest_coordinate(const Mesh& mesh) {
    std::int64_t farthest = 0;
    for (const LatticePosition& vertex : mesh.vertices)
        for (const std::int32_t coordinate : vertex) farthest = std::max(farthest, std::abs(std::int64_t{coordinate}));
    return static_cast<std::uint64_t>(farthest);
}

}  // namespace

void PartsTold::take(std::uint64_t part, const MadePart& figures, const Mesh& mesh) {
    std::erase_if(made, [part](const MadePart& other) { return other.number == part; });
    std::erase_if(ranges, [part](const PartRange& range) { return range.part == part; });
    made.push_back(figures);
    made.back().farthest = farthest_coordinate(mesh);
    std::uint64_t attribute = 0;
    for (const AttributeRange& range : attribute_ranges(mesh)) ranges.push_back({part, attribute++, range});
}

void PartsTold::take(const ComparedContacts& compared) {
    unequal = compared.unequal;
    for (MadePart& part : made) part.own_vertices = part.vertices - compared.repeated.at(part.number);
}

PartExchange::Bytes PartsTold::packed() const {
    MessageWriter message;
    message.add(unequal.count);
    message.add_all(std::span<const std::size_t>(unequal.parts));
    message.add_all(std::span<const MadePart>(made));
    message.add_all(std::span<const PartRange>(ranges));
    return message.take();
}

void PartsTold::add(const PartExchange::Bytes& bytes) {
    MessageReader message(bytes);
    meniscus::add_unequal(message, unequal);
    message.append_to(made);
    message.append_to(ranges);
}

void PartsTold::add_unequal(const PartExchange::Bytes& bytes, UnequalSeams& unequal) {
    MessageReader message(bytes);
    meniscus::add_unequal(message, unequal);
}

MadePart PartsTold::sum() const {
    MadePart sum;
    for (const MadePart& part : made) sum.add(part);
    return sum;
}

std::vector<std::uint64_t> PartsTold::own_vertices() const {
    std::vector<std::uint64_t> own(made.size());
    for (const MadePart& part : made) own[part.number] = part.own_vertices;
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
