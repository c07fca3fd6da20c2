#include <limits>
#include <span>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/input_frame.hpp"
#include "support.hpp"
#include "whole_frames.hpp"

namespace meniscus::fuzz {

namespace {

/// As one after the other comes in. Throws what a stream ends with.
void receive(const v1::StreamRequest& request, server::test::WholeFrames& assembler, server::InputFrame& input) {
    switch (request.message_case()) {
        case v1::StreamRequest::kFrameBegin:
            assembler.begin(request.frame_begin(), input);
            require(input.bytes.size() <= std::size_t{1} << 20, "a frame is as large as the limit at most");
            break;
        case v1::StreamRequest::kFrameChunk:
            assembler.append(request.frame_chunk(), input);
            break;
        case v1::StreamRequest::kFrameEnd: {
            assembler.end();
            const ParticleFrame view = input.view();
            require(view.count() == input.particle_count, "a frame that has ended holds the particles announced");
            std::size_t bytes = view.positions.size_bytes() + view.quantized.size_bytes() + view.levels.size_bytes();
            for (const ParticleArray& array : view.arrays) {
                require(array.data.data() + array.data.size() <= input.bytes.data() + input.bytes.size() &&
                            array.data.size() == array.element_bytes() * view.count(),
                        "an array lies within the frame's bytes");
                bytes += array.data.size();
            }
            const std::size_t gaps = input.bytes.size() - bytes;
            require(bytes <= input.bytes.size() && gaps < 4 * (1 + view.arrays.size()),
                    "positions, levels and arrays are all of a frame's bytes, but for what aligns them");
            require(assembler.take_kept() == bytes, "a frame that has ended has arrived");
            break;
        }
        default:
            throw InvalidInput("not a message of a frame");
    }
}

v1::StreamRequest begin(std::uint64_t index, bool quantized, bool levels, std::span<const ParticleArray> arrays = {}) {
    v1::StreamRequest request;
    v1::FrameBegin& message = *request.mutable_frame_begin();
    message.set_frame_index(index);
    message.set_simulation_time(0.5);
    message.set_particle_count(2);
    *message.mutable_arrays() = conversion::particle_arrays(quantized, levels, arrays);
    if (quantized) {
        message.mutable_quantization_box()->mutable_min()->set_x(-1.0);
        message.mutable_quantization_box()->mutable_max()->set_x(1.0);
    }
    return request;
}

v1::StreamRequest chunk(std::size_t bytes) {
    v1::StreamRequest request;
    request.mutable_frame_chunk()->set_data(std::string(bytes, '\x01'));
    return request;
}

}  // namespace

void stream_requests(Bytes bytes) {
    server::Limits limits;
    limits.particles_per_frame = 100'000;
    limits.bytes_per_session = std::size_t{1} << 20;
    // One session in three makes no attributes.
    Settings settings;
    Front front(bytes);
    const std::uint64_t kind = front.number(1) % 3;
    settings.all_attributes = kind == 1;
    if (kind == 2) settings.attributes = {"velocity", "id"};
    server::test::WholeFrames assembler(limits, settings);
    server::InputFrame input(std::make_shared<MemoryAccount>(limits.bytes_per_session));
    may_refuse([&] {
        while (!front.empty()) {
            const Bytes message = front.piece(front.number(2));
            v1::StreamRequest request;
            if (!request.ParseFromArray(message.data(), static_cast<int>(message.size()))) return;
            receive(request, assembler, input);
        }
        assembler.end_of_stream();
    });
}

Seeds stream_request_seeds() {
    v1::StreamRequest end;
    end.mutable_frame_end();
    const std::vector<ParticleArray> arrays{{"id", {}, ElementType::uint32, 1},
                                            {"velocity", {}, ElementType::float32, 3}};
    const auto of_session = [](unsigned kind, const std::vector<v1::StreamRequest>& messages) {
        return number_bytes(kind, 1) + join(messages);
    };
    return {of_session(0, {begin(1, false, false), chunk(24), end, begin(2, true, true), chunk(5), chunk(9), end}),
            of_session(0, {begin(std::numeric_limits<std::uint64_t>::max(), false, true), chunk(26), end}),
            of_session(0, {begin(1, false, true, arrays), chunk(50), chunk(8), end}),
            of_session(1, {begin(1, true, true, arrays), chunk(46), end}),
            of_session(2, {begin(1, false, true, arrays), chunk(57), chunk(1), end})};
}

}  // namespace meniscus::fuzz
