#include "parts/packed_positions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "lattice/coordinates.hpp"

namespace meniscus {
namespace {

/// A position's three coordinates side by side.
__extension__ using PositionBits = unsigned __int128;

/// Positions of a group: their units are told from the least of these, along each axis in as many bits as it takes.
constexpr std::size_t packed_group = 128;

using FloatPosition = std::array<float, 3>;

struct PackedForm {
    std::array<std::int64_t, 3> least{};
    std::array<std::uint8_t, 3> bits{};  ///< of a coordinate: of x the lowest
    bool is_packed = false;              ///< else positions are there as they were

    static constexpr unsigned most_bits = 8 * sizeof(FloatPosition);
    static constexpr std::size_t written_bytes = sizeof least + sizeof bits + sizeof is_packed;

    unsigned position_bits() const { return unsigned{bits[0]} + bits[1] + bits[2]; }
    std::size_t position_bytes() const { return is_packed ? (position_bits() + 7) / 8 : sizeof(FloatPosition); }
    void write(MessageWriter& message) const {
        message.add(least);
        message.add(bits);
        message.add(is_packed);
    }
    static PackedForm read(MessageReader& message) {
        PackedForm form;
        form.least = message.get<std::array<std::int64_t, 3>>();
        form.bits = message.get<std::array<std::uint8_t, 3>>();
        const auto is_packed = message.get<std::uint8_t>();
        form.is_packed = is_packed == 1;
        if (is_packed > 1 || (form.is_packed && form.position_bits() > most_bits)) MessageReader::refuse();
        return form;
    }
};

class PackedGroup {
public:
    explicit PackedGroup(double units_per_length) : units_per_length_(units_per_length) {}
    void add(const float* position) { std::copy_n(position, 3, points_[count_++].begin()); }
    bool is_full() const { return count_ == packed_group; }

    void write(MessageWriter& message) {
        if (count_ == 0) return;
        const PackedForm form = choose_form();
        form.write(message);
        if (form.is_packed)
            write_packed(message, form);
        else
            message.add_bytes(std::as_bytes(std::span(points_).first(count_)));
        count_ = 0;
    }

    /// Returns where the next group's positions go.
    float* read(MessageReader& message, std::size_t count, float* to) const {
        const PackedForm form = PackedForm::read(message);
        const std::size_t size = form.position_bytes();
        const std::span<const std::byte> bytes = message.get_bytes(count * size);
        if (!form.is_packed) {
            std::memcpy(to, bytes.data(), bytes.size());
            return to + 3 * count;
        }
        for (std::size_t i = 0; i < count; ++i) {
            PositionBits number = 0;
            std::memcpy(&number, bytes.data() + i * size, size);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const PositionBits mask = (PositionBits{1} << form.bits[axis]) - 1;
                const std::uint64_t unit =
                    static_cast<std::uint64_t>(form.least[axis]) + static_cast<std::uint64_t>(number & mask);
                *to++ = place_of(static_cast<std::int64_t>(unit));
                number >>= form.bits[axis];
            }
        }
        return to;
    }

private:
    float place_of(std::int64_t unit) const {
        return static_cast<float>(static_cast<double>(unit) / units_per_length_);
    }

    /// Snaps them, too.
    PackedForm choose_form() {
        PackedForm form;
        bool are_found_again = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t least = INT64_MAX, greatest = INT64_MIN;
            for (std::size_t i = 0; i < count_; ++i) {
                const std::int64_t unit = snap(points_[i][axis], units_per_length_);
                // A place halfway between two units may be found again as the other one's.
                are_found_again &= snap(place_of(unit), units_per_length_) == unit;
                units_[i][axis] = unit;
                least = std::min(least, unit);
                greatest = std::max(greatest, unit);
            }
            form.least[axis] = least;
            form.bits[axis] = static_cast<std::uint8_t>(std::bit_width(static_cast<std::uint64_t>(greatest - least)));
        }
        form.is_packed = are_found_again && form.position_bits() <= PackedForm::most_bits;
        return form;
    }

    void write_packed(MessageWriter& message, const PackedForm& form) {
        const std::size_t size = form.position_bytes();
        // The last number's bytes reach beyond it.
        std::array<std::byte, packed_group * sizeof(FloatPosition) + sizeof(PositionBits)> bytes;
        for (std::size_t i = 0; i < count_; ++i) {
            PositionBits number = 0;
            for (std::size_t axis = 3; axis-- > 0;)
                number = number << form.bits[axis] | static_cast<PositionBits>(units_[i][axis] - form.least[axis]);
            std::memcpy(bytes.data() + i * size, &number, sizeof number);
        }
        message.add_bytes(std::span(bytes).first(count_ * size));
    }

    double units_per_length_;
    std::size_t count_ = 0;
    std::array<FloatPosition, packed_group> points_;
    std::array<std::array<std::int64_t, 3>, packed_group> units_;
};

}  // namespace

void add_positions(MessageWriter& message, std::span<const float> positions, std::span<const std::uint32_t> places,
                   double units_per_length) {
    const bool are_all = places.empty() || positions.empty();
    const std::size_t count = are_all ? positions.size() / 3 : places.size();
    message.add(static_cast<std::uint64_t>(count));
    message.add(units_per_length);
    PackedGroup group(units_per_length);
    for (std::size_t i = 0; i < count; ++i) {
        group.add(positions.data() + 3 * (are_all ? i : places[i]));
        if (group.is_full()) group.write(message);
    }
    group.write(message);
}

void append_positions(MessageReader& message, std::vector<float>& positions) {
    const auto count = message.get<std::uint64_t>();
    const PackedGroup group(message.get<double>());
    if (count / packed_group > message.bytes_left() / PackedForm::written_bytes) MessageReader::refuse();
    const std::size_t before = positions.size();
    positions.resize(before + 3 * count);
    float* to = positions.data() + before;
    for (std::uint64_t left = count; left != 0;) {
        const std::uint64_t some = std::min<std::uint64_t>(left, packed_group);
        to = group.read(message, some, to);
        left -= some;
    }
}

}  // namespace meniscus
