#include "formats/recordings/recorded_particles.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "files/delimited_messages.hpp"
#include "files/recording_format.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::formats {
namespace {

class Reader {
public:
    Reader(const files::RandomAccessFile& file, const RecordedFrame& frame)
        : file_(file),
          frame_(frame),
          messages_(file, frame.particles.first, frame.particles.first + frame.particles.size) {}

    RecordedParticles read() {
        RecordedParticles particles;
        begin(next(v1::StreamRequest::kFrameBegin, "frame_begin").frame_begin(), particles);
        fill(std::as_writable_bytes(std::span(particles.positions)));
        fill(std::as_writable_bytes(std::span(particles.quantized)));
        fill(std::as_writable_bytes(std::span(particles.levels)));
        for (NamedValues& array : particles.arrays) fill(array.data);
        if (!chunk_.empty()) fail("more bytes than its particles have");
        next(v1::StreamRequest::kFrameEnd, "frame_end");
        if (!messages_.at_end()) fail("messages behind frame_end");
        return particles;
    }

private:
    const v1::StreamRequest& next(v1::StreamRequest::MessageCase kind, const char* name) {
        const auto bytes = messages_.next(files::max_recorded_message_bytes);
        if (!bytes || !request_.ParseFromString(*bytes) || request_.message_case() != kind)
            fail(std::string("no ") + name + " where one is due");
        return request_;
    }

    void begin(const v1::FrameBegin& message, RecordedParticles& particles) {
        if (message.frame_index() != frame_.index || message.particle_count() != frame_.particle_count)
            fail("its frame_begin tells of frame " + std::to_string(message.frame_index()) + " with " +
                 std::to_string(message.particle_count()) + " particles");
        const conversion::ParticleLayout layout = this->layout(message);
        const std::uint64_t count = message.particle_count();
        // Before memory is allocated by it.
        if (count > frame_.particles.size / layout.particle_bytes)
            fail(std::to_string(count) + " particles of " + std::to_string(layout.particle_bytes) +
                 " bytes are announced, but only " + std::to_string(frame_.particles.size) + " bytes follow");
        if (layout.quantized) {
            particles.quantization_box = box(message);
            particles.quantized.resize(3 * count);
        } else {
            particles.positions.resize(3 * count);
        }
        if (layout.has_levels && layout.levels_after != layout.position_bytes)
            fail("array 'level' does not follow 'position'");
        if (layout.has_levels) particles.levels.resize(count);
        for (const conversion::FurtherArray& array : layout.further) {
            if (!array.can_be_attribute())
                fail("array '" + array.name + "' is " + conversion::form_of(array) + ", of which no attribute is made");
            particles.arrays.push_back({.name = array.name,
                                        .type = *array.type,
                                        .components = array.components,
                                        .data = std::vector<std::byte>(count * array.bytes)});
        }
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

    /// Fills `out` from the chunks, whose cuts may fall anywhere.
    void fill(std::span<std::byte> out) {
        while (!out.empty()) {
            if (chunk_.empty()) {
                const auto& data = next(v1::StreamRequest::kFrameChunk, "frame_chunk").frame_chunk().data();
                if (data.empty()) fail("an empty frame_chunk");
                chunk_ = std::as_bytes(std::span(data));
            }
            const std::size_t size = std::min(out.size(), chunk_.size());
            std::memcpy(out.data(), chunk_.data(), size);
            out = out.subspan(size);
            chunk_ = chunk_.subspan(size);
        }
    }

    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("frame " + std::to_string(frame_.index) + ", at byte " + std::to_string(messages_.position()) +
                   ": " + what);
    }

    const files::RandomAccessFile& file_;
    const RecordedFrame& frame_;
    files::DelimitedMessages messages_;
    v1::StreamRequest request_;
    std::span<const std::byte> chunk_;  ///< what is left of the one in request_
};

}  // namespace

RecordedParticles read_recorded_particles(const files::RandomAccessFile& file, const RecordedFrame& frame) {
    return Reader(file, frame).read();
}

}  // namespace meniscus::formats
