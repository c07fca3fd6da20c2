// Positions, their boxes, and particle levels.
#include <bit>
#include <limits>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// The last float32 coordinate that the tests' cell size can address, 419378.8, and the first that it cannot.
constexpr float last_coordinate = 419378.78125F;
constexpr float first_beyond = 419378.8125F;

/// A frame of one particle.
std::function<grpc::Status(RunningServer&)> particle(float x, float y, float z, const std::string& level = {}) {
    std::string bytes;
    for (const float value : {x, y, z}) {
        const auto raw = std::bit_cast<std::array<char, sizeof(float)>>(value);
        bytes.append(raw.data(), raw.size());
    }
    bytes += level;
    return after_a_good_frame([bytes, has_levels = !level.empty()](RawStream& s) {
        s.call->Write(frame_begin(1, has_levels));
        s.call->Write(chunk_of(bytes));
        s.send_end();
    });
}

v1::StreamRequest quantized_begin(std::uint64_t particles) {
    v1::StreamRequest request = frame_begin(particles);
    *request.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(true, false);
    return request;
}

/// A frame of one particle over a box that reaches from (low, 0, 0) to (high, 1, 1).
std::function<grpc::Status(RunningServer&)> box(double low, double high) {
    return after_a_good_frame([=](RawStream& s) {
        v1::StreamRequest request = quantized_begin(1);
        v1::Box& wire = *request.mutable_frame_begin()->mutable_quantization_box();
        wire.mutable_min()->set_x(low);
        wire.mutable_max()->set_x(high);
        wire.mutable_max()->set_y(1.0);
        wire.mutable_max()->set_z(1.0);
        s.call->Write(request);
        s.send_chunk(6);
        s.send_end();
    });
}

}  // namespace

std::vector<BadInputCase> position_cases() {
    constexpr double far = 1e300;
    return {
        {"APositionThatIsNoNumber", invalid, "frame 11: particle 0 has y = nan, positions must be finite",
         particle(0.0F, nan, 0.0F)},
        {"APositionAtInfinity", invalid, "frame 11: particle 0 has z = inf, positions must be finite",
         particle(0.0F, 0.0F, infinity)},
        {"APositionAtMinusInfinity", invalid, "frame 11: particle 0 has x = -inf, positions must be finite",
         particle(-infinity, 0.0F, 0.0F)},
        {"ThePositionFarthestFromTheOrigin", ok, "", particle(last_coordinate, -last_coordinate, last_coordinate)},
        {"APositionBeyondTheLattice", invalid,
         "frame 11: particle 0 has x = 419378.812, farther from the origin than the 419378.8 that this cell size can "
         "address",
         particle(first_beyond, 0.0F, 0.0F)},
        {"TheLargestPosition", invalid, "farther from the origin than the 419378.8",
         particle(0.0F, 0.0F, std::numeric_limits<float>::lowest())},
        {"TheCoarsestLevel", ok, "", particle(0.0F, 0.0F, 0.0F, "\x03")},
        {"ALevelPastTheCoarsest", invalid, "frame 11: particle 0 has level 4, must be 0 to 3",
         particle(0.0F, 0.0F, 0.0F, "\x04")},
        {"TheLargestLevelByte", invalid, "frame 11: particle 0 has level 255, must be 0 to 3",
         particle(0.0F, 0.0F, 0.0F, "\xff")},
        {"NoQuantizationBox", invalid, "frame 11: positions of uint16 need a quantization_box",
         after_a_good_frame([](RawStream& s) { s.call->Write(quantized_begin(0)); })},
        {"AQuantizationBoxWithoutACorner", invalid, "quantization_box needs both its corners, min and max",
         after_a_good_frame([](RawStream& s) {
             v1::StreamRequest request = quantized_begin(0);
             request.mutable_frame_begin()->mutable_quantization_box()->mutable_min();
             s.call->Write(request);
         })},
        {"AFlatQuantizationBox", ok, "", box(1.0, 1.0)},
        {"AnInvertedQuantizationBox", invalid,
         "frame 11: quantization_box runs from 2 to 1 on the x axis; max must not be below min", box(2.0, 1.0)},
        {"AQuantizationBoxThatIsNoNumber", invalid,
         "frame 11: quantization_box runs from nan to 1 on the x axis; it must be finite", box(double{nan}, 1.0)},
        {"AnEndlessQuantizationBox", invalid,
         "frame 11: quantization_box runs from 0 to inf on the x axis; it must be finite", box(0.0, double{infinity})},
        {"AHugeQuantizationBox", invalid,
         "the quantization box reaches from -1e+300 to 1e+300, farther from the origin than the 419378.8",
         box(-far, far)},
        {"AQuantizationBoxAsLargeAsTheLattice", ok, "", box(double{-last_coordinate}, double{last_coordinate})},
        {"AQuantizationBoxBeyondTheLattice", invalid, "the quantization box reaches from 0 to 419378.812",
         box(0.0, double{first_beyond})},
    };
}

}  // namespace meniscus::server::test
