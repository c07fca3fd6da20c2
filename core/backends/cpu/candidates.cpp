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

void Candidates::gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box) {
    count_ = 0;
    support_ = set.support;
    inverse_support_ = 1.0F / set.support;
    if (set.cells.brick_count == 0) return;
    set.for_each_near(origin, box, [this](float x, float y, float z, float weight) {
        // Room for whole lanes beyond the last one.
        if (count_ + Lanes::count >= x_.size()) reserve(std::max<std::size_t>(256, 2 * x_.size()));
        x_[count_] = x;
        y_[count_] = y;
        z_[count_] = z;
        weight_[count_] = weight;
        ++count_;
    });
}

void Candidates::cull(const Candidates& from, const std::array<float, 3>& offset, const UnitBox& box) {
    support_ = from.support_;
    inverse_support_ = from.inverse_support_;
    reserve(from.x_.size());
    const Lanes reach2((support_ + 1.0F) * (support_ + 1.0F));
    const Lanes offset_x(offset[0]), offset_y(offset[1]), offset_z(offset[2]);
    const auto gap2 = [&box](std::size_t axis, Lanes p) {
        const Lanes gap = larger(larger(Lanes(box.low[axis]) - p, p - Lanes(box.high[axis])), Lanes(0.0F));
        return gap * gap;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < from.count_; i += Lanes::count) {
        const Lanes x = Lanes::load(&from.x_[i]) - offset_x;
        const Lanes y = Lanes::load(&from.y_[i]) - offset_y;
        const Lanes z = Lanes::load(&from.z_[i]) - offset_z;
        unsigned near = not_above(gap2(0, x) + gap2(1, y) + gap2(2, z), reach2);
        if (from.count_ - i < Lanes::count) near &= (1U << (from.count_ - i)) - 1;
        store_set(&x_[count], x, near);
        store_set(&y_[count], y, near);
        store_set(&z_[count], z, near);
        store_set(&weight_[count], Lanes::load(&from.weight_[i]), near);
        count += static_cast<std::size_t>(popcount(near));
    }
    count_ = count;
}

CandidateLists::CandidateLists(const std::shared_ptr<MemoryAccount>& account)
    : cluster{Candidates(account), Candidates(account), Candidates(account), Candidates(account)},
      near{Candidates(account), Candidates(account), Candidates(account), Candidates(account)} {}

}  // namespace meniscus::cpu
