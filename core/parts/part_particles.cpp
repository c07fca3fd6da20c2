// Particles near a part, by the place that a position decodes to.
#include "parts/part_particles.hpp"

#include "parts/message.hpp"

namespace meniscus {
namespace {

/// World coordinates of a frame's particles, as far as the question of a box needs them.
class Places {
public:
    explicit Places(const ParticleFrame& frame) : frame_(frame) {}

    double coordinate(std::size_t particle, std::size_t axis) const {
        if (!frame_.is_quantized()) return static_cast<double>(frame_.positions[3 * particle + axis]);
        const auto& [min, max] = frame_.quantization_box;
        return min[axis] +
               static_cast<double>(frame_.quantized[3 * particle + axis]) * (max[axis] - min[axis]) / 65535.0;
    }
    bool are_in(std::size_t particle, const Box& box) const {
        bool are_in = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = coordinate(particle, axis);
            are_in = are_in & (x >= box.min[axis]) & (x <= box.max[axis]);
        }
        return are_in;
    }

private:
    const ParticleFrame& frame_;
};

/// Of the particles within the box.
std::vector<std::uint32_t> places_within(const ParticleFrame& frame, const Box& box) {
    const Places places(frame);
    std::vector<std::uint32_t> chosen(frame.count());
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.count(); ++i) {
        chosen[count] = static_cast<std::uint32_t>(i);
        count += places.are_in(i, box) ? 1 : 0;
    }
    chosen.resize(count);
    return chosen;
}

}  // namespace

FrameForm::FrameForm(const ParticleFrame& frame)
    : is_quantized(frame.is_quantized()), quantization_box(frame.quantization_box), has_levels(!frame.levels.empty()) {
    for (const ParticleArray& array : frame.arrays)
        arrays.push_back({std::string(array.name), array.type, array.components});
}

std::vector<ParticleArray> FrameForm::without_values() const {
    std::vector<ParticleArray> all;
    for (const Array& array : arrays) all.push_back({array.name, {}, array.type, array.components});
    return all;
}

std::vector<std::byte> particles_within(const ParticleFrame& frame, const Box& box, const Box& around) {
    MessageWriter message;
    bool are_all_in = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (around.max[axis] < box.min[axis] || around.min[axis] > box.max[axis]) return message.take();
        are_all_in = are_all_in && around.min[axis] >= box.min[axis] && around.max[axis] <= box.max[axis];
    }
    const std::vector<std::uint32_t> chosen = are_all_in ? std::vector<std::uint32_t>() : places_within(frame, box);
    const std::size_t count = are_all_in ? frame.count() : chosen.size();
    if (count == 0) return message.take();
    // With the counts of the arrays, and the byte that Agreement adds.
    std::size_t bytes = (frame.arrays.size() + 3) * sizeof(std::uint64_t) + 1;
    const auto each = [](const auto& values) { return values.empty() ? 0 : sizeof values[0]; };
    bytes += count * (3 * (each(frame.positions) + each(frame.quantized)) + each(frame.levels));
    for (const ParticleArray& array : frame.arrays) bytes += count * array.element_bytes();
    message.reserve(bytes);
    const auto add = [&](const auto& values, std::size_t numbers) {
        if (are_all_in || values.empty())
            message.add_all(values);
        else
            message.add_some(values, numbers, chosen);
    };
    add(frame.positions, 3);
    add(frame.quantized, 3);
    add(frame.levels, 1);
    for (const ParticleArray& array : frame.arrays) add(array.data, array.element_bytes());
    return message.take();
}

void PartParticles::begin(FrameForm form) {
    form_ = std::move(form);
    positions_.clear();
    quantized_.clear();
    levels_.clear();
    arrays_.resize(form_.arrays.size());
    for (std::vector<std::byte>& array : arrays_) array.clear();
}

void PartParticles::assign(const ParticleFrame& frame) {
    begin(FrameForm(frame));
    positions_.assign(frame.positions.begin(), frame.positions.end());
    quantized_.assign(frame.quantized.begin(), frame.quantized.end());
    levels_.assign(frame.levels.begin(), frame.levels.end());
    for (std::size_t a = 0; a < arrays_.size(); ++a)
        arrays_[a].assign(frame.arrays[a].data.begin(), frame.arrays[a].data.end());
}

void PartParticles::add(std::span<const std::byte> message) {
    if (message.empty()) return;
    MessageReader reader(message);
    reader.append_to(positions_);
    reader.append_to(quantized_);
    reader.append_to(levels_);
    for (std::vector<std::byte>& array : arrays_) reader.append_to(array);
}

const ParticleFrame& PartParticles::frame() {
    frame_ = {};
    frame_.positions = positions_;
    frame_.quantized = quantized_;
    frame_.quantization_box = form_.quantization_box;
    frame_.levels = levels_;
    borrowed_.clear();
    for (std::size_t a = 0; a < arrays_.size(); ++a)
        borrowed_.push_back({form_.arrays[a].name, arrays_[a], form_.arrays[a].type, form_.arrays[a].components});
    frame_.arrays = borrowed_;
    return frame_;
}

}  // namespace meniscus
