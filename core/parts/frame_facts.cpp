// Facts of a frame's particles as messages.
#include "parts/frame_facts.hpp"

#include "meniscus/error.hpp"
#include "parts/message.hpp"

namespace meniscus {

PartExchange::Bytes packed(const FrameFacts& facts) {
    MessageWriter message;
    message.add(facts.by_level);
    message.add(facts.form.is_quantized);
    message.add(facts.form.quantization_box);
    message.add(facts.form.has_levels);
    message.add(static_cast<std::uint64_t>(facts.form.arrays.size()));
    for (const FrameForm::Array& array : facts.form.arrays) {
        message.add_text(array.name);
        message.add(array.type);
        message.add(array.components);
    }
    message.add_all(std::span<const BrickLoad>(facts.loads));
    message.add(static_cast<std::uint64_t>(facts.ranges.size()));
    for (const ArrayRange& range : facts.ranges) {
        message.add_text(range.name);
        message.add(range.component);
        message.add(range.least);
        message.add(range.greatest);
    }
    return message.take();
}

namespace {

FrameFacts unpacked_facts(const PartExchange::Bytes& bytes) {
    MessageReader message(bytes);
    FrameFacts facts;
    facts.by_level = message.get<ParticlesByLevel>();
    facts.form.is_quantized = message.get<bool>();
    facts.form.quantization_box = message.get<Box>();
    facts.form.has_levels = message.get<bool>();
    for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
        FrameForm::Array& array = facts.form.arrays.emplace_back();
        array.name = message.get_text();
        array.type = message.get<ElementType>();
        array.components = message.get<std::uint64_t>();
    }
    message.append_to(facts.loads);
    for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
        ArrayRange& range = facts.ranges.emplace_back();
        range.name = message.get_text();
        range.component = message.get<std::uint32_t>();
        range.least = message.get<float>();
        range.greatest = message.get<float>();
    }
    return facts;
}

}  // namespace

FrameFacts facts_together(const std::vector<PartExchange::Bytes>& of_ranks) {
    FrameFacts all;
    for (const PartExchange::Bytes& bytes : of_ranks) {
        FrameFacts facts = unpacked_facts(bytes);
        all.loads.insert(all.loads.end(), facts.loads.begin(), facts.loads.end());
        if (facts.particles() == 0) {
            // Of any form; where nobody has particles, the arrays that are named give a mesh its attributes.
            if (all.particles() == 0 && all.form.arrays.empty()) all.form = std::move(facts.form);
            continue;
        }
        if (all.particles() != 0 && !(facts.form == all.form))
            throw InvalidInput(
                "the processes' particles come in different encodings, or with different arrays: all must bring the "
                "same");
        all.form = std::move(facts.form);
        for (std::size_t level = 0; level < all.by_level.size(); ++level) all.by_level[level] += facts.by_level[level];
        widen(all.ranges, facts.ranges);
    }
    return all;
}

}  // namespace meniscus
