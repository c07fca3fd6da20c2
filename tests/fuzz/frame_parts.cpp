// Frames that several streams announce and send in parts, in any order of their chunks.
#include <algorithm>
#include <cstring>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/frame_assembler.hpp"
#include "sessions/intake/frame_plan.hpp"
#include "support.hpp"
#include "whole_frames.hpp"

namespace meniscus::fuzz {

namespace {

constexpr std::size_t most_parts = 4;

/// The bytes of a part's particles, of which each says of which part it is.
std::string bytes_of(const server::FramePart& part, std::size_t number) {
    return std::string(server::arriving_bytes(part), static_cast<char>('a' + number));
}

/// Whether each array has the bytes of one part behind those of the part before.
bool are_in_order(const ParticleFrame& frame, const std::vector<server::FramePart>& parts) {
    std::vector<std::span<const std::byte>> arrays{std::as_bytes(frame.positions), std::as_bytes(frame.quantized),
                                                   std::as_bytes(frame.levels)};
    for (const ParticleArray& array : frame.arrays) arrays.push_back(array.data);
    const std::size_t count = frame.count();
    return std::ranges::all_of(arrays, [&](std::span<const std::byte> array) {
        if (array.empty()) return true;
        std::size_t at = 0;
        for (std::size_t p = 0; p < parts.size(); ++p)
            for (const std::size_t end = at + array.size() / count * parts[p].particle_count; at < end; ++at)
                if (array[at] != static_cast<std::byte>('a' + p)) return false;
        return at == array.size();
    });
}

}  // namespace

void frame_parts(Bytes bytes) {
    server::Limits limits;
    limits.particles_per_frame = 100'000;
    limits.bytes_per_session = std::size_t{1} << 20;
    Settings settings;
    Front front(bytes);
    settings.all_attributes = front.number(1) % 2 == 1;
    server::InputFrame input(std::make_shared<MemoryAccount>(limits.bytes_per_session));
    may_refuse([&] {
        std::deque<server::FrameAssembler> assemblers;
        std::vector<server::FramePart> parts;
        const std::size_t count = 1 + front.number(1) % most_parts;
        for (std::size_t p = 0; p < count; ++p) {
            const Bytes message = front.piece(front.number(2));
            v1::FrameBegin begin;
            if (!begin.ParseFromArray(message.data(), static_cast<int>(message.size()))) return;
            begin.set_frame_index(7);
            parts.push_back(assemblers.emplace_back(limits, settings).announce(begin));
        }
        auto pieces = server::begin_frame(parts, limits, input);
        require(input.bytes.size() <= std::size_t{1} << 20, "a frame is as large as the limit at most");
        std::vector<std::string> left;
        std::size_t kept = 0;
        for (std::size_t p = 0; p < count; ++p) {
            assemblers[p].place(parts[p], std::move(pieces[p]));
            // Arrays that are passed over may be large.
            if (server::arriving_bytes(parts[p]) > std::size_t{1} << 21) return;
            left.push_back(bytes_of(parts[p], p));
        }
        // What is left of the input says which part sends how much, then all send the rest.
        for (std::size_t turn = 0; std::ranges::any_of(left, [](const auto& rest) { return !rest.empty(); }); ++turn) {
            const std::size_t p = front.empty() ? turn % count : front.number(1) % count;
            v1::FrameChunk chunk;
            chunk.set_data(left[p].substr(0, front.empty() ? server::chunk_bytes : front.number(2)));
            left[p].erase(0, chunk.data().size());
            assemblers[p].append(chunk, input);
            kept += assemblers[p].take_kept();
        }
        for (server::FrameAssembler& assembler : assemblers) assembler.end();
        const ParticleFrame frame = input.view();
        require(frame.count() == input.particle_count, "a frame that has ended holds the particles announced");
        require(kept == server::test::bytes_of(frame), "all parts that have ended are the frame");
        require(are_in_order(frame, parts), "the particles of one part lie behind those of the part before");
    });
}

Seeds frame_parts_seeds() {
    const auto begin = [](std::uint64_t count, bool levels, bool array) {
        v1::FrameBegin message;
        message.set_particle_count(count);
        std::vector<ParticleArray> arrays;
        if (array) arrays = {{"id", {}, ElementType::uint32, 1}, {"velocity", {}, ElementType::float32, 3}};
        *message.mutable_arrays() = conversion::particle_arrays(false, levels, arrays);
        return message;
    };
    const auto of_parts = [](unsigned all, const std::vector<v1::FrameBegin>& parts, const std::string& order) {
        return number_bytes(all, 1) + number_bytes(static_cast<std::uint32_t>(parts.size() - 1), 1) + join(parts) +
               order;
    };
    return {of_parts(0, {begin(3, true, false), begin(0, false, false), begin(5, true, false)},
                     number_bytes(2, 1) + number_bytes(9, 2)),
            of_parts(1, {begin(3, true, true), begin(4, true, true)},
                     number_bytes(1, 1) + number_bytes(17, 2) + number_bytes(0, 1) + number_bytes(5, 2)),
            of_parts(1, {begin(3, true, true), begin(4, false, true)}, ""),
            of_parts(0, {begin(std::numeric_limits<std::uint64_t>::max(), false, false), begin(7, false, false)}, ""),
            of_parts(0, {begin(60'000, false, false), begin(60'000, false, false)}, "")};
}

}  // namespace meniscus::fuzz
