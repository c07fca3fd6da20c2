#include "backends/cpu/candidates.hpp"

#include <algorithm>

#include "field/lanes.hpp"

namespace meniscus::cpu {

Candidates::Candidates(const std::shared_ptr<MemoryAccount>& account)
    : x_(make_array<float>(account)), y_(make_array<float>(account)), z_(make_array<float>(account)), weight_(make_array<float>(account)) {}

void Candidates::reserve(std::size_t n) {
    if (n <= x_.size()) return;
    for (Array<float>* a : {&x_, &y_, &z_, &weight_}) a->resize(n);
}

void Candidates::append_near(const CandidateView& from, const std::array<float, 3>& shift, const UnitBox& box) {
    if (count_ + from.count + Lanes::count > x_.size()) reserve(std::max(count_ + from.count + Lanes::count, 2 * x_.size()));
    const Lanes reach2(reach_ * reach_);
    const Lanes shift_x(shift[0]), shift_y(shift[1]), shift_z(shift[2]);
    const auto gap2 = [&box](std::size_t axis, Lanes p) {
        const Lanes gap = larger(larger(Lanes(box.low[axis]) - p, p - Lanes(box.high[axis])), Lanes(0.0F));
        return gap * gap;
    };
    std::size_t count = count_;
    for (std::size_t i = 0; i < from.count; i += Lanes::count) {
        const Lanes x = Lanes::load(from.x + i) + shift_x;
        const Lanes y = Lanes::load(from.y + i) + shift_y;
        const Lanes z = Lanes::load(from.z + i) + shift_z;
        unsigned near = not_above(gap2(0, x) + gap2(1, y) + gap2(2, z), reach2);
        if (from.count - i < Lanes::count) near &= (1U << (from.count - i)) - 1;
        store_set(&x_[count], x, near);
        store_set(&y_[count], y, near);
        store_set(&z_[count], z, near);
        store_set(&weight_[count], Lanes::load(from.weight + i), near);
        count += static_cast<std::size_t>(popcount(near));
    }
    count_ = count;
}

void Candidates::gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box) {
    count_ = 0;
    reach_ = set.reach();
    inverse_support_ = 1.0F / set.support;
    if (set.cells.brick_count == 0) return;
    set.for_each_run_near(origin, box, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
        append_near({set.x + begin, set.y + begin, set.z + begin, set.weight + begin, end - begin, inverse_support_},
                    {shift[0], shift[1], shift[2]}, box);
    });
}

void Candidates::cull(const Candidates& from, const std::array<float, 3>& shift, const UnitBox& box) {
    count_ = 0;
    reach_ = from.reach_;
    inverse_support_ = from.inverse_support_;
    append_near(from.view(), shift, box);
}

CandidateLists::CandidateLists(const std::shared_ptr<MemoryAccount>& account)
    : cluster{Candidates(account), Candidates(account), Candidates(account), Candidates(account)},
      near{Candidates(account), Candidates(account), Candidates(account), Candidates(account)} {}

}  // namespace meniscus::cpu
