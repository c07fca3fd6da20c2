#include "model/ptx_warp.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "model/ptx_codes.hpp"

namespace meniscus::benchmarks {
namespace {

constexpr std::uint32_t all_lanes = ~0U;

}  // namespace

void PtxWarp::begin(PtxBlock& of, unsigned warp) {
    block = &of;
    state = State::runs;
    at_ = 0;
    mask_ = all_lanes;
    clock = 0.0;
    parked_.clear();
    std::fill(ready_.begin(), ready_.end(), 0.0);
    for (const PtxPreset& preset : program_.kernel().presets)
        for (unsigned lane = 0; lane < warp_lanes; ++lane) {
            std::uint64_t& value = values(preset.slot)[lane];
            const auto workspace = reinterpret_cast<std::uint64_t>(grid_.workspace);
            switch (preset.what) {
                case PtxPreset::What::constant:
                    value = preset.value;
                    break;
                case PtxPreset::What::parameter_address:
                    value = reinterpret_cast<std::uint64_t>(grid_.parameters[preset.value]);
                    break;
                case PtxPreset::What::thread:
                    value = warp * warp_lanes + lane;
                    break;
                case PtxPreset::What::block:
                    value = of.index;
                    break;
                case PtxPreset::What::threads:
                    value = grid_.launch.threads;
                    break;
                case PtxPreset::What::blocks:
                    value = grid_.launch.blocks;
                    break;
                case PtxPreset::What::lane:
                    value = lane;
                    break;
                case PtxPreset::What::workspace_high:
                    value = workspace >> 32;
                    break;
                case PtxPreset::What::workspace_low:
                    value = workspace & all_lanes;
                    break;
            }
        }
}

void PtxWarp::park(std::int32_t at, std::uint32_t mask, bool waits) {
    if (mask == 0) return;
    for (Group& group : parked_)
        if (group.at == at) {
            group.mask |= mask;
            group.waits = false;  // with more lanes it may go on
            return;
        }
    parked_.push_back({at, mask, waits});
}

bool PtxWarp::take_next() {
    const Group* lowest = nullptr;
    for (const Group& group : parked_)
        if (!group.waits && (lowest == nullptr || group.at < lowest->at)) lowest = &group;
    if (lowest == nullptr) return false;
    at_ = lowest->at;
    mask_ = lowest->mask;
    parked_.erase(parked_.begin() + (lowest - parked_.data()));
    return true;
}

void PtxWarp::join_here() {
    for (std::size_t g = 0; g < parked_.size(); ++g)
        if (parked_[g].at == at_) {
            mask_ |= parked_[g].mask;
            parked_.erase(parked_.begin() + static_cast<std::ptrdiff_t>(g));
            return;
        }
}

bool PtxWarp::all_here(std::uint32_t wanted) {
    if ((wanted & ~mask_) == 0) return true;
    parked_.push_back({at_, mask_, true});
    if (!take_next()) throw std::runtime_error("lanes wait for some that do not come: " + program_.kernel().name);
    return false;
}

/// In order: an instruction waits for its operands. Its issue and pipes are added up from all executions, in the end.
inline void PtxWarp::account(const PtxInstruction& i, const InstructionCost& cost, std::uint32_t mask, double latency) {
    lanes_ += static_cast<std::uint64_t>(std::popcount(mask));
    for (std::size_t k = 0; k < i.from_count; ++k) clock = std::max(clock, ready_[static_cast<std::size_t>(i.from[k])]);
    if (i.guard >= 0) clock = std::max(clock, ready_[static_cast<std::size_t>(i.guard)]);
    clock += cost.issued;
    for (std::size_t k = 0; k < i.to_count; ++k) ready_[static_cast<std::size_t>(i.to[k])] = clock + latency;
}

void PtxWarp::shuffle(const PtxInstruction& i, std::uint32_t mask) {
    const PtxLanes given = slot(i.from[0]);
    const PtxLanes by = slot(i.from[1]);
    const PtxLanes limits = slot(i.from[2]);
    for (unsigned lane = 0; lane < warp_lanes; ++lane) {
        if ((mask >> lane & 1) == 0) continue;
        const auto distance = static_cast<unsigned>(by.of[lane] & 31);
        const auto clamp = static_cast<unsigned>(limits.of[lane] & 31);
        const auto segment = static_cast<unsigned>(limits.of[lane] >> 8 & 31);
        const unsigned first = lane & segment;
        const unsigned last = first | (clamp & ~segment);
        const auto way = static_cast<PtxShuffle>(i.detail);
        unsigned from = lane ^ distance;
        switch (way) {
            case PtxShuffle::index:
                from = first | (distance & ~segment);
                break;
            case PtxShuffle::up:
                from = lane - distance;
                break;
            case PtxShuffle::down:
                from = lane + distance;
                break;
            case PtxShuffle::exclusive_or:
                break;
        }
        // Upwards the clamp is the lowest lane that one may come from.
        const bool is_inside = way == PtxShuffle::up ? lane >= distance && from >= (first | clamp) : from <= last;
        values(i.to[0])[lane] = given.of[is_inside ? from : lane];
        if (i.to[1] >= 0) values(i.to[1])[lane] = is_inside ? 1 : 0;
    }
}

void PtxWarp::run() {
    const std::vector<PtxInstruction>& code = program_.kernel().instructions;
    for (;;) {
        if (!parked_.empty()) {
            const PtxInstruction& next = code[static_cast<std::size_t>(at_)];
            if (next.is_target) {
                park(at_, mask_, false);
                take_next();
            } else {
                join_here();
            }
        }
        const auto number = static_cast<std::size_t>(at_);
        const PtxInstruction& i = code[number];
        const InstructionCost& cost = program_.cost(number);
        std::uint32_t mask = mask_;
        if (i.guard >= 0) {
            const std::uint64_t* const guard = values(i.guard);
            std::uint32_t holds = 0;
            for (unsigned lane = 0; lane < warp_lanes; ++lane)
                holds |= static_cast<std::uint32_t>(guard[lane] & 1) << lane;
            mask &= i.guard_is_negated ? ~holds : holds;
        }
        const auto wanted = [&](std::size_t operand) {
            return static_cast<std::uint32_t>(values(i.from[operand])[std::countr_zero(mask_)]);
        };
        double latency = cost.latency;
        switch (i.kind) {
            case PtxKind::compute:
                if (mask != 0) i.compute(i, slots_.data(), mask);
                break;
            case PtxKind::load:
                latency = load(i, mask);
                break;
            case PtxKind::store:
                latency = store(i, mask);
                break;
            case PtxKind::atomic:
                latency = change(i, mask);
                break;
            case PtxKind::shuffle:
                if (!all_here(wanted(3))) continue;
                shuffle(i, mask);
                break;
            case PtxKind::ballot: {
                if (!all_here(wanted(1))) continue;
                std::uint64_t votes = 0;
                for (unsigned lane = 0; lane < warp_lanes; ++lane)
                    votes |= std::uint64_t{(mask >> lane & 1) != 0 && values(i.from[0])[lane] != 0} << lane;
                for (unsigned lane = 0; lane < warp_lanes; ++lane)
                    if ((mask >> lane & 1) != 0) values(i.to[0])[lane] = votes;
                break;
            }
            case PtxKind::warp_barrier:
                if (!all_here(wanted(0))) continue;
                break;
            case PtxKind::trap:
                throw std::runtime_error("a kernel traps: " + program_.kernel().name);
            case PtxKind::branch:
            case PtxKind::block_barrier:
            case PtxKind::end:
            case PtxKind::nothing:
                break;
        }
        program_.add_execution(number);
        account(i, cost, mask, latency);
        if (i.kind == PtxKind::branch) {
            const std::uint32_t stay = mask_ & ~mask;
            if (mask == 0) {
                ++at_;
            } else if (stay == 0) {
                at_ = i.target;
            } else {
                park(at_ + 1, stay, false);
                park(i.target, mask, false);
                take_next();
            }
            continue;
        }
        if (i.kind == PtxKind::end) {
            park(at_ + 1, mask_ & ~mask, false);
            if (take_next()) continue;
            if (!parked_.empty())
                throw std::runtime_error("lanes wait for some that have ended: " + program_.kernel().name);
            state = State::ended;
            return;
        }
        if (i.kind == PtxKind::block_barrier) {
            if (!parked_.empty()) {
                // The lanes of a warp come one after another.
                parked_.push_back({at_, mask_, true});
                if (!take_next()) throw std::runtime_error("warp_lanes part at a barrier: " + program_.kernel().name);
                continue;
            }
            ++at_;
            state = State::waits_for_block;
            return;
        }
        ++at_;
        if (i.is_acquire) return;
    }
}

}  // namespace meniscus::benchmarks
