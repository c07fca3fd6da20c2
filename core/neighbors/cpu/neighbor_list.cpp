// Lists of neighbors, culled by whole registers.
#include "neighbors/cpu/neighbor_list.hpp"

#include <algorithm>
#include <cstring>

#include "field/cubic_spline.hpp"
#include "field/lanes.hpp"
#include "particles/attributes.hpp"

namespace meniscus::cpu {

/// A box, to find the distances of points from it.
class NeighborList::UnitBoxLanes {
public:
    explicit UnitBoxLanes(const UnitBox& box) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = WideLanes(box.low[axis]);
            high_[axis] = WideLanes(box.high[axis]);
        }
    }
    WideLanes squared_distance(WideLanes x, WideLanes y, WideLanes z) const {
        const WideLanes dx = from_box(0, x);
        const WideLanes dy = from_box(1, y);
        const WideLanes dz = from_box(2, z);
        return fma(dx, dx, fma(dy, dy, dz * dz));
    }

private:
    WideLanes from_box(int axis, WideLanes p) const { return p - max(min(p, high_[axis]), low_[axis]); }

    WideLanes low_[3], high_[3];
};

NeighborList::NeighborList(const std::shared_ptr<MemoryAccount>& account, bool has_own_supports, Carried carried)
    : x_(make_array<float>(account)),
      y_(make_array<float>(account)),
      z_(make_array<float>(account)),
      weight_(make_array<float>(account)),
      fall_(make_array<float>(account)),
      ranks_(make_array<float>(account)),
      values_(make_array<float>(account)),
      may_have_own_supports_(has_own_supports),
      carried_(carried) {}

void NeighborList::reserve(std::size_t n) {
    if (n <= x_.size()) return;
    for (Array<float>* a : {&x_, &y_, &z_, &weight_}) a->resize(n);
    if (may_have_own_supports_) fall_.resize(n);
    if (carried_ != Carried::nothing) ranks_.resize(n);
    if (carried_ == Carried::ranks_and_values) values_.resize(group_size_of_numbers * n);
}

// Inlined whole, wherever it is called: the four forms are too much for the compiler to do it by itself, and what it
// then passes by memory costs a third of a search.
template <bool has_own_supports, bool has_ranks, class IsNear>
[[gnu::always_inline]] inline void NeighborList::append(const NeighborView& from, const std::array<float, 3>& shift,
                                                        const UnitBoxLanes& box, const IsNear& is_near) {
    float* const to_x = x_.data();
    float* const to_y = y_.data();
    float* const to_z = z_.data();
    float* const to_weight = weight_.data();
    float* const to_fall = fall_.data();
    float* const to_ranks = ranks_.data();
    std::size_t count = count_;
    const WideLanes shift_x(shift[0]), shift_y(shift[1]), shift_z(shift[2]);
    const auto append_lanes = [&, own = from ](std::size_t i, unsigned of) __attribute__((always_inline)) {
        const WideLanes x = WideLanes::load(own.x + i) + shift_x;
        const WideLanes y = WideLanes::load(own.y + i) + shift_y;
        const WideLanes z = WideLanes::load(own.z + i) + shift_z;
        const unsigned near = is_near(i, box.squared_distance(x, y, z)) & of;
        compress_store(to_x + count, x, near);
        compress_store(to_y + count, y, near);
        compress_store(to_z + count, z, near);
        compress_store(to_weight + count, WideLanes::load(own.weight + i), near);
        if constexpr (has_own_supports) compress_store(to_fall + count, WideLanes::load(own.fall + i), near);
        if constexpr (has_ranks) compress_store(to_ranks + count, WideLanes::load(own.ranks + i), near);
        count += static_cast<std::size_t>(popcount(near));
    };
    const std::size_t rest = from.count % WideLanes::count;
    const std::size_t whole = from.count - rest;
    for (std::size_t i = 0; i < whole; i += WideLanes::count) append_lanes(i, (1U << WideLanes::count) - 1);
    if (rest != 0) append_lanes(whole, (1U << rest) - 1);
    count_ = count;
}

template <bool has_ranks>
void NeighborList::append_near(const NeighborView& from, const std::array<float, 3>& shift, const UnitBoxLanes& box) {
    if (count_ + from.count + WideLanes::count > x_.size())
        reserve(std::max(count_ + from.count + WideLanes::count, 2 * x_.size()));
    if (has_own_supports_) {
        // A little farther than the support, since distances are rounded.
        append<true, has_ranks>(from, shift, box, [&](std::size_t i, WideLanes d2) {
            return less_equal(WideLanes::load(from.fall + i) * d2,
                              WideLanes::load(from.weight + i) * WideLanes(1.0001F));
        });
    } else {
        const WideLanes reach2(reach_ * reach_);
        append<false, has_ranks>(from, shift, box, [&](std::size_t, WideLanes d2) { return less_equal(d2, reach2); });
    }
}

void NeighborList::gather(const ParticleSetView& set, const Units3& origin, const UnitBox& box) {
    count_ = 0;
    if (set.cells.brick_count == 0) return;
    has_own_supports_ = set.fall != nullptr;
    has_ranks_ = set.ranks != nullptr;
    reach_ = set.reach();
    support_ = set.support;
    inverse_support_ = inverse_support(set.support);
    const UnitBoxLanes lanes(box);
    const auto append_run = [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
        const std::array<float, 3> by{shift[0], shift[1], shift[2]};
        NeighborView run{set.x + begin,
                         set.y + begin,
                         set.z + begin,
                         set.weight + begin,
                         has_own_supports_ ? set.fall + begin : nullptr,
                         end - begin,
                         support_,
                         inverse_support_};
        if (!has_ranks_) {
            append_near<false>(run, by, lanes);
            return;
        }
        run.ranks = set.ranks + begin;
        append_near<true>(run, by, lanes);
    };
    set.for_each_run_near(origin, box, hints_, append_run);
}

void NeighborList::cull(const NeighborList& from, const std::array<float, 3>& shift, const UnitBox& box) {
    count_ = 0;
    if (from.count_ == 0) return;
    has_own_supports_ = from.has_own_supports_;
    has_ranks_ = from.has_ranks_ && carried_ != Carried::nothing;
    reach_ = from.reach_;
    support_ = from.support_;
    inverse_support_ = from.inverse_support_;
    const UnitBoxLanes lanes(box);
    has_ranks_ ? append_near<true>(from.view(), shift, lanes) : append_near<false>(from.view(), shift, lanes);
}

void NeighborList::fetch_values(const float* of_set) {
    for (std::size_t j = 0; j < count_; ++j) {
        constexpr std::size_t size = group_size_of_numbers;
        std::memcpy(values_.data() + size * j, of_set + size * AttributeNumber::as_bits(ranks_[j]),
                    size * sizeof(float));
    }
}

namespace {

NeighborLists::Levels lists_of_levels(const std::shared_ptr<MemoryAccount>& account, const LatticeSettings& settings,
                                      NeighborList::Carried carried) {
    const auto list = [&] {
        return NeighborList(account, settings.has_own_supports,
                            settings.may_have_attributes ? carried : NeighborList::Carried::nothing);
    };
    return {list(), list(), list(), list()};
}

}  // namespace

NeighborLists::NeighborLists(const std::shared_ptr<MemoryAccount>& account, const LatticeSettings& settings)
    : group(lists_of_levels(account, settings, NeighborList::Carried::ranks)),
      cluster(lists_of_levels(account, settings, NeighborList::Carried::ranks)),
      near(lists_of_levels(account, settings, NeighborList::Carried::ranks_and_values)),
      nearer(lists_of_levels(account, settings, NeighborList::Carried::nothing)) {}

}  // namespace meniscus::cpu
