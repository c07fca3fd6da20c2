// Particles near a part, by the place that a position decodes to.
#include "parts/part_particles.hpp"

#include "particles/positions.hpp"
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
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = coordinate(particle, axis);
            if (x < box.min[axis] || x > box.max[axis]) return false;
        }
        return true;
    }

private:
    const ParticleFrame& frame_;
};

/// The values of the chosen particles, `count` for each.
template <class T>
void add_chosen(MessageWriter& message, std::span<const T> values, std::size_t count,
                std::span<const std::uint32_t> chosen) {
    std::vector<T> some;
    some.reserve(values.empty() ? 0 : chosen.size() * count);
    for (const std::uint32_t i : chosen)
        if (!values.empty())
            some.insert(some.end(), values.begin() + static_cast<std::ptrdiff_t>(i * count),
                        values.begin() + static_cast<std::ptrdiff_t>((i + std::size_t{1}) * count));
    message.add_all(std::span<const T>(some));
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

std::vector<std::byte> particles_within(const ParticleFrame& frame, const Box& box) {
    const Places places(frame);
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < frame.count(); ++i)
        if (places.are_in(i, box)) chosen.push_back(static_cast<std::uint32_t>(i));
    MessageWriter message;
    if (chosen.empty()) return message.take();
    add_chosen(message, frame.positions, 3, chosen);
    add_chosen(message, frame.quantized, 3, chosen);
    add_chosen(message, frame.levels, 1, chosen);
    for (const ParticleArray& array : frame.arrays) add_chosen(message, array.data, array.element_bytes(), chosen);
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
