#include "parts/part_particles.hpp"

#include <utility>

#include "parts/message.hpp"
#include "parts/packed_positions.hpp"

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

ParticleFrame PartParticles::keep(const HandedFrame& handed) {
    const ParticleFrame& given = handed.frame;
    begin(FrameForm(given));
    if (!handed.positions_stay) {
        positions_.assign(given.positions.begin(), given.positions.end());
        quantized_.assign(given.quantized.begin(), given.quantized.end());
    }
    if (!handed.rest_stays) {
        levels_.assign(given.levels.begin(), given.levels.end());
        for (std::size_t a = 0; a < arrays_.size(); ++a)
            arrays_[a].assign(given.arrays[a].data.begin(), given.arrays[a].data.end());
    }
    ParticleFrame kept = frame();
    if (handed.positions_stay) {
        kept.positions = given.positions;
        kept.quantized = given.quantized;
    }
    if (handed.rest_stays) {
        kept.levels = given.levels;
        for (std::size_t a = 0; a < borrowed_.size(); ++a) borrowed_[a].data = given.arrays[a].data;
    }
    return kept;
}

void PartParticles::add(std::span<const std::byte> message) {
    if (message.empty()) return;
    MessageReader reader(message);
    append_positions(reader, positions_);
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
