#include "parts/dealt_frame.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "parts/brick_deal.hpp"

namespace meniscus {

void DealtFrame::prepare(const Settings& settings, const PartsOptions& options) {
    facts = facts_together(told);
    BrickDeal dealt = deal_bricks(std::move(facts.loads), options.parts);
    rank_of_ = deal_parts(dealt, options.makers);
    own_ = std::move(dealt.boxes);
    overlaps_.assign(own_.size(), options.overlap);
    of_rank_.resize(told.size());
    told.clear();
    wanted_.resize(own_.size());
    std::iota(wanted_.begin(), wanted_.end(), std::size_t{0});
    deal_turns();
    near_.begin(mine, settings);
    write(settings);
}

/// One part of each process at a time: of the particles near it there is one copy beside the frame.
void DealtFrame::deal_turns() {
    for (std::vector<std::size_t>& its : of_rank_) its.clear();
    turn_ = turns_ = 0;
    for (const std::size_t part : wanted_) {
        std::vector<std::size_t>& its = of_rank_[rank_of_[part]];
        its.push_back(part);
        turns_ = std::max(turns_, its.size());
    }
}

void DealtFrame::write(const Settings& settings) {
    messages_.resize(of_rank_.size());
    for (std::size_t rank = 0; rank < messages_.size(); ++rank)
        if (const std::size_t* const made = part_of(rank); made != nullptr)
            messages_[rank] =
                near_.within(reach_of(part(*made), settings, facts.coarsest_level()), std::move(messages_[rank]));
        else
            messages_[rank].clear();
}

std::uint32_t DealtFrame::greatest_overlap() const {
    return *std::max_element(overlaps_.begin(), overlaps_.end());
}

const std::size_t* DealtFrame::part_of(std::size_t rank) const {
    return turn_ < of_rank_[rank].size() ? &of_rank_[rank][turn_] : nullptr;
}

void DealtFrame::make_again(std::vector<std::size_t> parts) {
    wanted_ = std::move(parts);
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    for (const std::size_t part : wanted_) {
        if (overlaps_[part] == max_overlap)
            throw ProcessFailed("part " + std::to_string(part) +
                                " fits to its neighbors at no overlap: all processes of a frame must run the same "
                                "version with the same settings");
        overlaps_[part] = std::min(2 * overlaps_[part], max_overlap);
    }
    deal_turns();
}

}  // namespace meniscus
