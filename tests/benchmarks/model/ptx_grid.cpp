#include "model/ptx_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "model/ptx_codes.hpp"

namespace meniscus::benchmarks {
namespace {

constexpr std::uint32_t all_lanes = ~0U;
constexpr unsigned lanes = 32;
constexpr std::uint64_t sector_bytes = 32;
constexpr std::uint64_t line_bytes = 128;
/// In which threads only ask for a word that others may change.
constexpr unsigned most_idle_rounds = 100'000;

/// The first cache of one block: the newest line for each remainder, with a bit for each of its sectors that is there.
class FirstCache {
public:
    explicit FirstCache(std::uint64_t bytes) : lines_(std::max<std::uint64_t>(64, bytes / line_bytes)) {}
    /// Whether a sector was there already.
    bool ask(std::uint64_t sector) {
        const std::uint64_t line = sector / (line_bytes / sector_bytes);
        const auto bit = static_cast<std::uint8_t>(1U << sector % (line_bytes / sector_bytes));
        Line& at = lines_[line % lines_.size()];
        if (at.number != line) at = {line, 0};
        const bool was_there = (at.sectors & bit) != 0;
        at.sectors |= bit;
        return was_there;
    }

private:
    struct Line {
        std::uint64_t number = ~std::uint64_t{0};
        std::uint8_t sectors = 0;
    };
    std::vector<Line> lines_;
};

/// Different sectors of a launch.
class Footprint {
public:
    /// Whether the sector is a new one.
    bool add(std::uint64_t sector) {
        std::uint64_t& bits = seen_[sector / 64];
        const std::uint64_t bit = std::uint64_t{1} << sector % 64;
        const bool is_new = (bits & bit) == 0;
        bits |= bit;
        return is_new;
    }

private:
    std::unordered_map<std::uint64_t, std::uint64_t> seen_;
};

/// What the warps of a launch share.
struct Grid {
    const PtxLaunch& launch;
    void* const* parameters;
    const GpuConstants& gpu;
    LaunchCounts counts;
    Footprint footprint;
    std::uint32_t workspace[2] = {0, 0};  ///< of grid barriers: the second word is their counter
    double first_cache_latency, second_cache_latency, shared_latency, atomic_latency;

    Grid(const PtxLaunch& l, void* const* p, const GpuConstants& g)
        : launch(l),
          parameters(p),
          gpu(g),
          first_cache_latency(g["first_cache_latency"]),
          second_cache_latency(g["second_cache_latency"]),
          shared_latency(g["shared_latency"]),
          atomic_latency(g["atomic_latency"]) {}
};

/// A block's shared memory, first cache and barrier.
class PtxBlock {
public:
    PtxBlock(const PtxProgram& program, const Grid& grid)
        : shared(program.kernel().shared_bytes + 16),
          cache(static_cast<std::uint64_t>(grid.gpu["first_cache_bytes"]) /
                std::max(1U, grid.launch.blocks_of_processor)) {
        std::fill(shared.begin(), shared.end(), std::byte{0xA5});
    }
    std::vector<std::byte> shared;
    FirstCache cache;
    unsigned index = 0;
    unsigned at_barrier = 0;  ///< warps that wait there
    unsigned running = 0;     ///< warps that have not ended
    double barrier_clock = 0.0;
};

/// 32 lanes with their registers. Lanes at one instruction are a group; the lowest group runs first.
class PtxWarp {
public:
    enum class State : std::uint8_t { runs, waits_for_block, ended };

    PtxWarp(PtxProgram& program, Grid& grid) : program_(program), grid_(grid) {
        slots_.resize(static_cast<std::size_t>(program.kernel().slots));
        ready_.resize(slots_.size());
    }
    void begin(PtxBlock& block, unsigned warp);
    /// Until it ends, waits for its block, or has asked for a word that others may change.
    void run();
    State state = State::ended;
    PtxBlock* block = nullptr;
    double clock = 0.0;
    /// In use, summed over all instructions of all blocks.
    std::uint64_t lanes_in_use() const { return lanes_; }

private:
    struct Group {
        std::int32_t at;
        std::uint32_t mask;
        bool waits;  ///< for other lanes, to do something together
    };

    PtxLanes& slot(std::int32_t i) { return slots_[static_cast<std::size_t>(i)]; }
    std::uint64_t* values(std::int32_t i) { return slot(i).of; }
    void park(std::int32_t at, std::uint32_t mask, bool waits);
    /// Goes on with the lowest group that does not wait; false without any.
    bool take_next();
    /// Lanes that are parked at the current instruction go on with the others.
    void join_here();
    /// Whether all lanes of the mask are here; parks this group otherwise.
    bool all_here(std::uint32_t wanted);
    void account(const PtxInstruction& i, const InstructionCost& cost, std::uint32_t mask, double latency);
    std::byte* address(const PtxInstruction& i, unsigned lane);
    double access(const PtxInstruction& i, std::uint32_t mask);
    double load(const PtxInstruction& i, std::uint32_t mask);
    double store(const PtxInstruction& i, std::uint32_t mask);
    double change(const PtxInstruction& i, std::uint32_t mask);
    void shuffle(const PtxInstruction& i, std::uint32_t mask);

    PtxProgram& program_;
    Grid& grid_;
    std::vector<PtxLanes> slots_;
    std::vector<double> ready_;  ///< cycle at which each slot's value can be used
    std::vector<Group> parked_;
    std::int32_t at_ = 0;
    std::uint32_t mask_ = 0;

    std::uint64_t lanes_ = 0;
};

void PtxWarp::begin(PtxBlock& of, unsigned warp) {
    block = &of;
    state = State::runs;
    at_ = 0;
    mask_ = all_lanes;
    clock = 0.0;
    parked_.clear();
    std::fill(ready_.begin(), ready_.end(), 0.0);
    for (const PtxPreset& preset : program_.kernel().presets)
        for (unsigned lane = 0; lane < lanes; ++lane) {
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
                    value = warp * lanes + lane;
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

std::byte* PtxWarp::address(const PtxInstruction& i, unsigned lane) {
    const std::uint64_t base = values(i.from[0])[lane];
    if (i.space == PtxSpace::shared) {
        const std::uint64_t at = static_cast<std::uint32_t>(base) + static_cast<std::uint64_t>(i.offset);
        if (at + std::uint64_t{i.element_bytes} * i.elements > block->shared.size())
            throw std::runtime_error("shared memory is overrun: " + program_.kernel().name);
        return block->shared.data() + at;
    }
    return reinterpret_cast<std::byte*>(base + static_cast<std::uint64_t>(i.offset));
}

/// Counts what an access asks memory for; returns the cycles until a load has it.
double PtxWarp::access(const PtxInstruction& i, std::uint32_t mask) {
    LaunchCounts& counts = grid_.counts;
    const std::uint64_t bytes = std::uint64_t{i.element_bytes} * i.elements;
    if (i.space == PtxSpace::parameter) return 0.0;
    if (i.space == PtxSpace::shared) {
        // Different words of one bank come one after another.
        std::array<std::uint64_t, lanes> words{};
        unsigned count = 0;
        for (std::uint32_t left = mask; left != 0; left &= left - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(left));
            const auto offset = static_cast<std::uint64_t>(address(i, lane) - block->shared.data());
            words[count++] = offset / 4;
        }
        std::sort(words.begin(), words.begin() + count);
        const auto end = std::unique(words.begin(), words.begin() + count);
        std::array<std::uint8_t, lanes> of_bank{};
        unsigned passes = 1;
        for (auto word = words.begin(); word != end; ++word)
            passes = std::max<unsigned>(passes, ++of_bank[*word % lanes]);
        const double all = std::max<double>(
            passes, static_cast<double>(end - words.begin()) * static_cast<double>(bytes) / line_bytes);
        counts.memory_passes += all;
        return grid_.shared_latency + all;
    }
    std::array<std::uint64_t, 4 * lanes> sectors{};
    unsigned count = 0;
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto at = reinterpret_cast<std::uint64_t>(address(i, static_cast<unsigned>(std::countr_zero(left))));
        for (std::uint64_t s = at / sector_bytes; s <= (at + bytes - 1) / sector_bytes && count < sectors.size(); ++s)
            if (count == 0 || sectors[count - 1] != s) sectors[count++] = s;
    }
    std::sort(sectors.begin(), sectors.begin() + count);
    const auto end = std::unique(sectors.begin(), sectors.begin() + count);
    std::uint64_t line = ~std::uint64_t{0};
    double passes = 0.0;
    bool misses = false;
    const bool is_cached = i.kind == PtxKind::load && !i.is_acquire;
    for (auto sector = sectors.begin(); sector != end; ++sector) {
        counts.sectors += 1.0;
        if (*sector / 4 != line) passes += 1.0;
        line = *sector / 4;
        if (!is_cached || !block->cache.ask(*sector)) {
            misses = true;
            counts.missed_sectors += 1.0;
            if (grid_.footprint.add(*sector)) counts.own_sectors += 1.0;
        }
    }
    counts.memory_passes += passes;
    if (i.kind == PtxKind::atomic) return grid_.atomic_latency;
    return passes + (misses ? grid_.second_cache_latency : grid_.first_cache_latency);
}

double PtxWarp::load(const PtxInstruction& i, std::uint32_t mask) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const std::byte* const from = address(i, lane);
        std::array<std::uint64_t, 4> got{};
        for (unsigned k = 0; k < i.elements; ++k) {
            std::memcpy(&got[k], from + k * i.element_bytes, i.element_bytes);
            // Into a register of any width, of which a narrower one's readers take no more than they need.
            if (i.is_signed && i.element_bytes < 8) {
                const unsigned above = 64 - 8U * i.element_bytes;
                got[k] = static_cast<std::uint64_t>(static_cast<std::int64_t>(got[k] << above) >> above);
            }
        }
        for (unsigned k = 0; k < i.elements; ++k) values(i.to[k])[lane] = got[k];
    }
    return access(i, mask);
}

double PtxWarp::store(const PtxInstruction& i, std::uint32_t mask) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        std::byte* const to = address(i, lane);
        for (unsigned k = 0; k < i.elements; ++k)
            std::memcpy(to + k * i.element_bytes, &values(i.from[k + 1])[lane], i.element_bytes);
    }
    access(i, mask);
    return 0.0;
}

double PtxWarp::change(const PtxInstruction& i, std::uint32_t mask) {
    const unsigned bits = 8U * i.element_bytes;
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        std::byte* const at = address(i, lane);
        std::uint64_t before = 0;
        std::memcpy(&before, at, i.element_bytes);
        const std::uint64_t by = values(i.from[1])[lane];
        const auto number = [&](std::uint64_t value) {
            return static_cast<std::int64_t>(value << (64 - bits)) >> (64 - bits);
        };
        const bool by_is_greater = i.is_signed ? number(by) > number(before) : by > before;
        std::uint64_t after = by;
        switch (static_cast<PtxAtomic>(i.detail)) {
            case PtxAtomic::add:
                after = before + by;
                break;
            case PtxAtomic::bit_or:
                after = before | by;
                break;
            case PtxAtomic::bit_and:
                after = before & by;
                break;
            case PtxAtomic::max:
                after = by_is_greater ? by : before;
                break;
            case PtxAtomic::min:
                after = by_is_greater ? before : by;
                break;
            case PtxAtomic::compare_and_swap:
                after = before == by ? values(i.from[2])[lane] : before;
                break;
            case PtxAtomic::exchange:
            case PtxAtomic::unknown:
                break;
        }
        std::memcpy(at, &after, i.element_bytes);
        if (i.to[0] >= 0) values(i.to[0])[lane] = before;
    }
    if (i.opcode.find(".release") != std::string::npos) grid_.counts.grid_barriers += 1.0;
    return access(i, mask);
}

void PtxWarp::shuffle(const PtxInstruction& i, std::uint32_t mask) {
    const PtxLanes given = slot(i.from[0]);
    const PtxLanes by = slot(i.from[1]);
    const PtxLanes limits = slot(i.from[2]);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        if ((mask >> lane & 1) == 0) continue;
        const auto distance = static_cast<unsigned>(by.of[lane] & 31);
        const auto clamp = static_cast<unsigned>(limits.of[lane] & 31);
        const auto segment = static_cast<unsigned>(limits.of[lane] >> 8 & 31);
        const unsigned first = lane & segment;
        const unsigned last = first | (clamp & ~segment);
        unsigned from = lane;
        bool is_inside = true;
        switch (static_cast<PtxShuffle>(i.detail)) {
            case PtxShuffle::index:
                from = first | (distance & ~segment);
                is_inside = from <= last;
                break;
            case PtxShuffle::up:
                // Here the clamp is the lowest lane that one may come from.
                is_inside = lane >= distance && lane - distance >= (first | clamp);
                from = lane - distance;
                break;
            case PtxShuffle::down:
                from = lane + distance;
                is_inside = from <= last;
                break;
            case PtxShuffle::exclusive_or:
                from = lane ^ distance;
                is_inside = from <= last;
                break;
        }
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
            for (unsigned lane = 0; lane < lanes; ++lane) holds |= static_cast<std::uint32_t>(guard[lane] & 1) << lane;
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
                for (unsigned lane = 0; lane < lanes; ++lane)
                    votes |= std::uint64_t{(mask >> lane & 1) != 0 && values(i.from[0])[lane] != 0} << lane;
                for (unsigned lane = 0; lane < lanes; ++lane)
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
                if (!take_next()) throw std::runtime_error("lanes part at a barrier: " + program_.kernel().name);
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

}  // namespace

LaunchCounts& LaunchCounts::operator+=(const LaunchCounts& other) {
    issued += other.issued;
    for (std::size_t p = 0; p < pipe_count; ++p) pipe[p] += other.pipe[p];
    ptx += other.ptx;
    lanes += other.lanes;
    memory_passes += other.memory_passes;
    sectors += other.sectors;
    missed_sectors += other.missed_sectors;
    own_sectors += other.own_sectors;
    warp_cycles += other.warp_cycles;
    longest_warp = std::max(longest_warp, other.longest_warp);
    grid_barriers += other.grid_barriers;
    warps += other.warps;
    blocks += other.blocks;
    return *this;
}

PtxProgram::PtxProgram(PtxKernel kernel, const InstructionCosts& costs) : kernel_(std::move(kernel)) {
    for (const PtxInstruction& i : kernel_.instructions) cost_.push_back(costs.of(i.opcode));
    executed_.resize(kernel_.instructions.size());
}

double PtxProgram::static_issued() const {
    double sum = 0.0;
    for (const InstructionCost& cost : cost_) sum += cost.issued;
    return sum;
}

LaunchCounts PtxProgram::run(const PtxLaunch& launch, void* const* parameters, const GpuConstants& gpu) {
    Grid grid(launch, parameters, gpu);
    const std::vector<std::uint64_t> executed_before = executed_;
    const unsigned warps_of_block = launch.threads / lanes;
    const unsigned at_once = launch.is_cooperative ? launch.blocks : 1;
    std::vector<std::unique_ptr<PtxWarp>> warps;
    for (unsigned w = 0; w < at_once * warps_of_block; ++w) warps.push_back(std::make_unique<PtxWarp>(*this, grid));
    for (unsigned first = 0; first < launch.blocks; first += at_once) {
        std::vector<std::unique_ptr<PtxBlock>> blocks;
        for (unsigned b = 0; b < at_once; ++b) {
            blocks.push_back(std::make_unique<PtxBlock>(*this, grid));
            blocks.back()->index = first + b;
            blocks.back()->running = warps_of_block;
            for (unsigned w = 0; w < warps_of_block; ++w) warps[b * warps_of_block + w]->begin(*blocks.back(), w);
        }
        unsigned running = at_once * warps_of_block;
        unsigned idle_rounds = 0;
        while (running != 0) {
            if (++idle_rounds > most_idle_rounds)
                throw std::runtime_error("threads wait for a word that nobody changes: " + kernel_.name);
            bool progress = false;
            for (const auto& warp : warps) {
                if (warp->state != PtxWarp::State::runs) continue;
                progress = true;
                warp->run();
                if (warp->state != PtxWarp::State::runs) idle_rounds = 0;
                if (warp->state == PtxWarp::State::ended) {
                    --running;
                    --warp->block->running;
                    grid.counts.warp_cycles += warp->clock;
                    grid.counts.longest_warp = std::max(grid.counts.longest_warp, warp->clock);
                } else if (warp->state == PtxWarp::State::waits_for_block) {
                    ++warp->block->at_barrier;
                    warp->block->barrier_clock = std::max(warp->block->barrier_clock, warp->clock);
                }
            }
            for (const auto& warp : warps) {
                PtxBlock& block = *warp->block;
                if (block.at_barrier == 0 || block.at_barrier != block.running) continue;
                for (const auto& other : warps)
                    if (other->block == &block && other->state == PtxWarp::State::waits_for_block) {
                        other->state = PtxWarp::State::runs;
                        other->clock = block.barrier_clock;
                    }
                block.at_barrier = 0;
                block.barrier_clock = 0.0;
                progress = true;
            }
            if (!progress) throw std::runtime_error("warps wait for some that do not come: " + kernel_.name);
        }
    }
    for (const auto& warp : warps) grid.counts.lanes += static_cast<double>(warp->lanes_in_use());
    for (std::size_t i = 0; i < executed_.size(); ++i) {
        const auto times = static_cast<double>(executed_[i] - executed_before[i]);
        grid.counts.ptx += times;
        grid.counts.issued += times * cost_[i].issued;
        grid.counts.pipe[static_cast<std::size_t>(cost_[i].pipe)] += times * cost_[i].cycles_of_pipe;
    }
    grid.counts.warps = std::uint64_t{launch.blocks} * warps_of_block;
    grid.counts.blocks = launch.blocks;
    if (launch.is_cooperative) grid.counts.grid_barriers /= launch.blocks;
    return grid.counts;
}

}  // namespace meniscus::benchmarks
