#include "sessions/intake/input_frame.hpp"

#include <bit>

namespace meniscus::server {

static_assert(std::endian::native == std::endian::little, "the wire's numbers are used in place");

void InputFrame::allocate(std::size_t size) {
    sent_ = {};
    in_flight_.announce(size);
    retained_.drop();
    shown_in_run.reset();
    brick_parts.clear();
    keep_arrays({});
    if (bytes.capacity() < size) {
        pinned_.drop();
        // A fresh array: growing the old one would hold both for a moment, and copy what nobody needs.
        Array<std::byte>(bytes.get_allocator()).swap(bytes);
        bytes.reserve(size);
    }
    bytes.resize(size);
}

void InputFrame::keep_arrays(std::vector<KeptArray> arrays) {
    arrays_ = std::move(arrays);
    array_views_.clear();
    for (const KeptArray& array : arrays_) {
        ParticleArray view{.name = array.name, .data = {}, .type = array.type, .components = array.components};
        view.data = {bytes.data() + array.offset, view.element_bytes() * particle_count};
        array_views_.push_back(view);
    }
}

std::size_t InputFrame::particle_bytes() const {
    const std::size_t coordinate_bytes = quantized ? sizeof(std::uint16_t) : sizeof(float);
    return particle_count * (3 * coordinate_bytes + (has_levels ? 1 : 0));
}

ParticleFrame InputFrame::view() const {
    ParticleFrame frame;
    const std::size_t coordinates = 3 * particle_count;
    std::size_t position_bytes = 0;
    if (quantized) {
        frame.quantized = {reinterpret_cast<const std::uint16_t*>(bytes.data()), coordinates};
        frame.quantization_box = quantization_box;
        position_bytes = frame.quantized.size_bytes();
    } else {
        frame.positions = {reinterpret_cast<const float*>(bytes.data()), coordinates};
        position_bytes = frame.positions.size_bytes();
    }
    if (has_levels)
        frame.levels = {reinterpret_cast<const std::uint8_t*>(bytes.data()) + position_bytes, particle_count};
    frame.arrays = array_views_;
    frame.sent = &sent_;
    return frame;
}

}  // namespace meniscus::server
