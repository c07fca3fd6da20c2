// A frame in parts: this process's particles of it, and the parts to which bricks are dealt, which all processes make
// in turns.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <vector>

#include "meniscus/part.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/settings.hpp"
#include "parts/frame_facts.hpp"
#include "parts/part_particles.hpp"
#include "parts/particles_near.hpp"

namespace meniscus {

/// Keeps its memory for the next frame. What it borrows stays where it is when two of them are swapped.
class DealtFrame {
public:
    std::chrono::steady_clock::time_point start;
    PartParticles kept;
    ParticleFrame mine;                     ///< borrows from the caller, and from what is kept
    std::vector<PartExchange::Bytes> told;  ///< by each process: its facts
    FrameFacts facts;                       ///< of all processes' particles; the loads until they are dealt
    std::exception_ptr error;               ///< of this process

    /// Puts together what was told, deals the bricks, and chooses `mine` for the first parts. Throws as
    /// facts_together().
    void prepare(const Settings& settings, const PartsOptions& options);
    /// Chooses `mine` for the parts of this turn.
    void write(const Settings& settings);
    /// What each process is sent for the part that it makes in this turn.
    std::vector<PartExchange::Bytes>& messages() { return messages_; }

    std::span<const BrickBox> own() const { return own_; }
    std::span<const std::size_t> rank_of() const { return rank_of_; }  ///< the process that makes each part
    FramePart part(std::size_t number) const { return {own_[number], overlaps_[number], facts.ranges}; }
    std::uint32_t greatest_overlap() const;

    /// The part that a process makes in this turn; null: none.
    const std::size_t* part_of(std::size_t rank) const;
    std::size_t turn() const { return turn_; }  ///< from 0
    /// Whether there is another turn, which then is this one.
    bool begin_next_turn() { return ++turn_ < turns_; }
    /// The parts that are made in these turns, of all processes.
    std::span<const std::size_t> wanted() const { return wanted_; }
    /// Those whose seams differ are made in the next turns, if there are any, with twice the overlap. Throws
    /// ProcessFailed where a part has settled all of space.
    void make_again(std::vector<std::size_t> parts);

private:
    void deal_turns();

    ParticlesNear near_;
    std::vector<PartExchange::Bytes> messages_;
    std::vector<BrickBox> own_;
    std::vector<std::size_t> rank_of_;
    std::vector<std::uint32_t> overlaps_;
    std::vector<std::size_t> wanted_;
    std::vector<std::vector<std::size_t>> of_rank_;  ///< of the wanted ones, those that each process makes, in turn
    std::size_t turns_ = 0, turn_ = 0;
};

}  // namespace meniscus
