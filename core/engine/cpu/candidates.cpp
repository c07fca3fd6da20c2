// Lists of particles near a box, culled eight at a time.
#include "engine/cpu/candidates.hpp"

#include <algorithm>

#include "field/lanes.hpp"

namespace meniscus::cpu {

/// The points no farther than `reach` from a box.
class Candidates::BoxVicinity {
public:
    BoxVicinity(const UnitBox& box, float reach) : reach2_(reach * reach) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = Lanes(box.low[axis]);
            high_[axis] = Lanes(box.high[axis]);
        }
    }
    /// The set of those of eight points that are.
    unsigned near(Lanes x, Lanes y, Lanes z) const {
        const Lanes dx = from_box(0, x);
        const Lanes dy = from_box(1, y);
        const Lanes dz = from_box(2, z);
        return less_equal(fma(dx, dx, fma(dy, dy, dz * dz)), reach2_);
    }

private:
    Lanes from_box(int axis, Lanes p) const { return p - max(min(p, high_[axis]), low_[axis]); }

    Lanes low_[3], high_[3], reach2_;
};

Candidates::Candidates(const std::shared_ptr<MemoryAccount>& account)
    : x_(make_array<float>(account)),
      y_(make_array<float>(account)),
      z_(make_array<float>(account)),
      weight_(make_array<float>(account)) {}

void Candidates::reserve(std::size_t n) {
    if (n <= x_.size()) return;
    for (Array<float>* a : {&x_, &y_, &z_, &weight_}) a->resize(n);
}

void Candidates::append_near(const CandidateView& from, const std::array<float, 3>& shift,
                             const BoxVicinity& vicinity) {
    if (count_ + from.count + Lanes::count > x_.size())
        reserve(std::max(count_ + from.count + Lanes::count, 2 * x_.size()));
    float* const to_x = x_.data();
    float* const to_y = y_.data();
    float* const to_z = z_.data();
    float* const to_weight = weight_.data();
    std::size_t count = count_;
    const Lanes shift_x(shift[0]), shift_y(shift[1]), shift_z(shift[2]);
    const auto append = [&, own = from](std::size_t i, unsigned of) {
        const Lanes x = Lanes::load(own.x + i) + shift_x;
        const Lanes y = Lanes::load(own.y + i) + shift_y;
        const Lanes z = Lanes::load(own.z + i) + shift_z;
        const unsigned near = vicinity.near(x, y, z) & of;
        compress_store(to_x + count, x, near);
        compress_store(to_y + count, y, near);
        compress_store(to_z + count, z, near);
        compress_store(to_weight + count, Lanes::load(own.weight + i), near);
        count += static_cast<std::size_t>(popcount(near));
    };
    const std::size_t rest = from.count % Lanes::count;
    const std::size_t whole = from.count - rest;
    for (std::size_t i = 0; i < whole; i += Lanes::count) append(i, 0xFF);
    if (rest != 0) append(whole, (1U << rest) - 1);
    count_ = count;
}

void Candidates::gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box) {
    count_ = 0;
    if (set.cells.brick_count == 0) return;
    reach_ = set.reach();
    inverse_support_ = inverse_support(set.support);
    const BoxVicinity vicinity(box, reach_);
    set.for_each_run_near(origin, box, hints_, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
        append_near({set.x + begin, set.y + begin, set.z + begin, set.weight + begin, end - begin, inverse_support_},
                    {shift[0], shift[1], shift[2]}, vicinity);
    });
}

void Candidates::cull(const Candidates& from, const std::array<float, 3>& shift, const UnitBox& box) {
    count_ = 0;
    if (from.count_ == 0) return;
    reach_ = from.reach_;
    inverse_support_ = from.inverse_support_;
    append_near(from.view(), shift, BoxVicinity(box, reach_));
}

CandidateLists::CandidateLists(const std::shared_ptr<MemoryAccount>& account)
    : cluster{Candidates(account), Candidates(account), Candidates(account), Candidates(account)},
      near{Candidates(account), Candidates(account), Candidates(account), Candidates(account)} {}

}  // namespace meniscus::cpu
