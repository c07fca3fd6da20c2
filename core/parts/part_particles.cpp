#include "parts/part_particles.hpp"

#include <utility>

#include "parts/message.hpp"

namespace meniscus {

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
