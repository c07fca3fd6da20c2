// A frame of particles from its messages, in a file or in a pipe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "files/recording_format.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::formats {

/// What the entry before the messages says of its frame.
struct AnnouncedFrame {
    std::uint64_t index = 0;
    std::uint64_t particle_count = 0;
    std::uint64_t bytes = 0;  ///< of the messages
};

/// Messages: next(limit), at_end(), position() and fail() as files::DelimitedMessages and files::RandomAccessFile have
/// them. Memory is taken for what has come, not for what was announced.
template <class Messages>
class RecordedFrameReader {
public:
    /// Borrows the messages.
    RecordedFrameReader(Messages& messages, const AnnouncedFrame& frame) : messages_(messages), frame_(frame) {}

    /// Fills the particles, whose memory stays. Throws InvalidInput unless the messages are exactly this frame.
    void read(RecordedParticles& particles) {
        const std::uint64_t count = frame_.particle_count;
        const conversion::ParticleLayout layout =
            begin(next(v1::StreamRequest::kFrameBegin, "frame_begin").frame_begin(), particles);
        fill(particles.positions, layout.quantized ? 0 : 3 * count);
        fill(particles.quantized, layout.quantized ? 3 * count : 0);
        fill(particles.levels, layout.has_levels ? count : 0);
        for (NamedValues& array : particles.arrays) fill(array.data, count * array.element_bytes());
        if (!chunk_.empty()) fail("more bytes than its particles have");
        next(v1::StreamRequest::kFrameEnd, "frame_end");
        if (!messages_.at_end()) fail("messages behind frame_end");
    }

private:
    const v1::StreamRequest& next(v1::StreamRequest::MessageCase kind, const char* name) {
        const auto bytes = messages_.next(files::max_recorded_message_bytes);
        if (!bytes || !request_.ParseFromString(*bytes) || request_.message_case() != kind)
            fail(std::string("no ") + name + " where one is due");
        return request_;
    }

    conversion::ParticleLayout begin(const v1::FrameBegin& message, RecordedParticles& particles) const {
        if (message.frame_index() != frame_.index || message.particle_count() != frame_.particle_count)
            fail("its frame_begin tells of frame " + std::to_string(message.frame_index()) + " with " +
                 std::to_string(message.particle_count()) + " particles");
        conversion::ParticleLayout layout = this->layout(message);
        if (frame_.particle_count > frame_.bytes / layout.particle_bytes)
            fail(std::to_string(frame_.particle_count) + " particles of " + std::to_string(layout.particle_bytes) +
                 " bytes are announced, but only " + std::to_string(frame_.bytes) + " bytes follow");
        if (layout.quantized) particles.quantization_box = box(message);
        if (layout.has_levels && layout.levels_after != layout.position_bytes)
            fail("array 'level' does not follow 'position'");
        particles.arrays.resize(layout.further.size());
        for (std::size_t a = 0; a < layout.further.size(); ++a) {
            const conversion::FurtherArray& array = layout.further[a];
            if (!array.can_be_attribute())
                fail("array '" + array.name + "' is " + conversion::form_of(array) + ", of which no attribute is made");
            particles.arrays[a].name = array.name;
            particles.arrays[a].type = *array.type;
            particles.arrays[a].components = array.components;
        }
        return layout;
    }

    conversion::ParticleLayout layout(const v1::FrameBegin& message) const {
        try {
            return conversion::particle_layout(message.arrays());
        } catch (const InvalidInput& e) {
            fail(e.what());
        }
    }

    Box box(const v1::FrameBegin& message) const {
        try {
            return conversion::from_wire(message.quantization_box(), "quantization_box");
        } catch (const InvalidInput& e) {
            fail(e.what());
        }
    }

    /// Fills `out` with `count` values from the chunks, whose cuts may fall anywhere.
    template <class Value>
    void fill(std::vector<Value>& out, std::uint64_t count) {
        out.clear();
        std::uint64_t left = count * sizeof(Value);
        while (left != 0) {
            if (chunk_.empty()) {
                const auto& data = next(v1::StreamRequest::kFrameChunk, "frame_chunk").frame_chunk().data();
                if (data.empty()) fail("an empty frame_chunk");
                chunk_ = std::as_bytes(std::span(data));
            }
            const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(left, chunk_.size()));
            const auto filled = static_cast<std::size_t>(count * sizeof(Value) - left);
            out.resize((filled + size + sizeof(Value) - 1) / sizeof(Value));
            std::memcpy(std::as_writable_bytes(std::span(out)).data() + filled, chunk_.data(), size);
            left -= size;
            chunk_ = chunk_.subspan(size);
        }
    }

    [[noreturn]] void fail(const std::string& what) const {
        messages_.fail("frame " + std::to_string(frame_.index) + ", at byte " + std::to_string(messages_.position()) +
                       ": " + what);
    }

    Messages& messages_;
    AnnouncedFrame frame_;
    v1::StreamRequest request_;
    std::span<const std::byte> chunk_;  ///< what is left of the one in request_
};

}  // namespace meniscus::formats
