// Parts in rounds: all are made, then those whose seams differ once more with twice the overlap, until none does.
#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/reconstructor.hpp"
#include "particles/attribute_choice.hpp"
#include "particles/seams.hpp"
#include "particles/validation.hpp"
#include "particles/warnings.hpp"
#include "parts/agreement.hpp"
#include "parts/brick_deal.hpp"
#include "parts/contacts.hpp"
#include "parts/frame_facts.hpp"
#include "parts/made_part.hpp"
#include "parts/part_particles.hpp"
#include "parts/particles_near.hpp"
#include "parts/parts_told.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus {
namespace {

/// Of a process beside a simulation, which are looked at for the deal: it has one part at most, and the parts' shares
/// are even to some percent.
constexpr std::size_t particles_for_deal = 8192;
/// Bricks with surface of such a process, likewise.
constexpr std::size_t bricks_for_deal = 8192;

}  // namespace

std::vector<PartExchange::Bytes> AloneExchange::gather(Bytes mine) {
    std::vector<Bytes> all;
    all.push_back(std::move(mine));
    return all;
}

class PartsReconstructor::Impl {
public:
    Impl(const Settings& settings, const BackendOptions& backend, const PartsOptions& options, PartExchange& exchange)
        : settings_(settings), options_(options), agreement_(exchange), choice_(settings) {
        validate(settings);
        deal_bricks({}, options.parts);
        FramePart part;
        part.overlap = options.overlap;
        validate(part);
        std::vector<std::size_t>& makers = options_.makers;
        if (makers.empty())
            for (std::size_t rank = 0; rank < exchange.ranks(); ++rank) makers.push_back(rank);
        if (makers.back() >= exchange.ranks())
            throw InvalidInput("parts are to be made by rank " + std::to_string(makers.back()) + ", but there are " +
                               std::to_string(exchange.ranks()) + " ranks, from 0 on");
        // A device, if there is one, is taken where it is needed alone.
        if (std::find(makers.begin(), makers.end(), exchange.rank()) != makers.end())
            reconstructor_.emplace(settings, backend);
    }

    enum class Pace { at_once, beside_a_simulation };

    void begin(const FrameGiver& give, Pace pace) {
        start_ = std::chrono::steady_clock::now();
        pace_ = pace;
        const auto of_ranks = agreement_.gather([&] {
            HandedFrame handed = give();
            // As a Reconstructor does, which passes over arrays that the frames before did not bring.
            validate_lengths(handed.frame);
            const std::vector<ParticleArray> chosen = choice_.of(handed.frame);
            handed.frame.sent = nullptr;
            handed.frame.arrays = chosen;
            mine_ = kept_.keep(handed);
            validate_places(mine_, settings_);
            near_.begin(mine_);
            return packed(facts_of(mine_));
        });
        bring([&] {
            facts_ = facts_together(of_ranks);
            // All processes hold the next frames against the same arrays, also one that has brought none.
            choice_.keep(facts_.form.without_values());
            BrickDeal deal = deal_bricks(std::move(facts_.loads), options_.parts);
            rank_of_ = deal_parts(deal, options_.makers);
            own_ = std::move(deal.boxes);
            overlaps_.assign(own_.size(), options_.overlap);
            told_ = {};
            borders_.clear();
            making_.clear();
            report_ = {};
            error_ = nullptr;
            wanted_.resize(own_.size());
            std::iota(wanted_.begin(), wanted_.end(), std::size_t{0});
            deal_turns();
        });
    }

    void make(const PartSink& sink) noexcept {
        if (turn_ >= mine_to_make_.size()) return;
        try {
            // Here, for it goes through all particles; where one process has them all.
            if (agreement_.ranks() == 1 && turn_ == 0 && report_.parts_made == 0)
                wrong_radius_ = find_wrong_radius(PlacedFrame(mine_), settings_);
            particles_.begin(facts_.form);
            for (PartExchange::Bytes& bytes : from_) {
                particles_.add(bytes);
                // The frames of a simulation follow each other in the same memory: new pages cost more than copies.
                // (`bytes = {}` would keep the memory.)
                if (pace_ == Pace::at_once) PartExchange::Bytes().swap(bytes);
            }
            make_one(mine_to_make_[turn_], particles_.frame(), sink);
        } catch (...) {
            error_ = std::current_exception();
        }
    }

    bool go_on() {
        ++turn_;
        if (turn_ == turns_) {
            std::vector<PartExchange::Bytes> told = compare();
            if (wanted_.empty()) {
                finish(std::move(told));
                return false;
            }
            deal_turns();
        }
        bring([&] { rethrow_error(); });
        return true;
    }

    PartsReport report() const {
        PartsReport report = finished_.report;
        PartsTold all;
        for (const PartExchange::Bytes& message : finished_.told) all.add(message);
        const MadePart sum = all.sum();
        report.particles_received = sum.particles;
        report.own_vertices = all.own_vertices();
        report.ranges = all.whole_ranges();
        report.farthest = sum.farthest;
        Statistics& whole = report.whole;
        whole.vertices = sum.own_vertices;
        whole.triangles_by_level = sum.triangles_by_level;
        for (const std::uint64_t triangles : sum.triangles_by_level) whole.triangles += triangles;
        whole.base_cells_by_level = sum.base_cells_by_level;
        whole.volume = world_volume(sum.sixfold_volume, world_cell_size(settings_), offset_bits(settings_));
        whole.spray_particles = sum.spray_particles;
        whole.vertices_without_particles = sum.vertices_without_particles;
        whole.field_evaluations = sum.field_evaluations;
        whole.stage_seconds = sum.stage_seconds;
        return report;
    }

private:
    FrameFacts facts_of(const ParticleFrame& mine) const {
        FrameFacts facts;
        facts.form = FrameForm(mine);
        facts.by_level = count_levels(mine);
        // One frame may have parts by the hundred, and the largest decides how much memory it takes: all count there.
        const std::size_t group = pace_ == Pace::at_once ? 1 : mine.count() / particles_for_deal;
        facts.loads = brick_loads(mine, settings_, static_cast<std::uint32_t>(agreement_.rank()),
                                  std::max<std::size_t>(group, 1));
        if (pace_ == Pace::beside_a_simulation)
            for (const auto& [part, surface] : surfaces_)
                facts.loads.insert(facts.loads.end(), surface.begin(), surface.end());
        facts.ranges = array_ranges(mine, settings_);
        return facts;
    }

    /// One part of each process at a time: of the particles near it there is one copy beside the frame.
    void deal_turns() {
        of_rank_.assign(agreement_.ranks(), {});
        turns_ = 0;
        for (const std::size_t part : wanted_) {
            std::vector<std::size_t>& its = of_rank_[rank_of_[part]];
            its.push_back(part);
            turns_ = std::max(turns_, its.size());
        }
        mine_to_make_ = of_rank_[agreement_.rank()];
        turn_ = 0;
    }

    /// prepare: what this process does before, and may throw.
    template <class Prepare>
    void bring(const Prepare& prepare) {
        agreement_.all_to_all(to_, from_, [&] {
            prepare();
            to_.resize(agreement_.ranks());
            for (std::size_t rank = 0; rank < to_.size(); ++rank) {
                if (turn_ < of_rank_[rank].size())
                    to_[rank] = near_.within(reach_of(part(of_rank_[rank][turn_]), settings_, facts_.coarsest_level()),
                                             std::move(to_[rank]));
                else
                    to_[rank].clear();
            }
        });
        if (pace_ == Pace::at_once) to_.clear();
    }

    FramePart part(std::size_t number) const { return {own_[number], overlaps_[number], facts_.ranges}; }

    void make_one(std::size_t number, const ParticleFrame& particles, const PartSink& sink) {
        const FramePart its = part(number);
        const PartOutcome outcome = reconstructor_->reconstruct_part(particles, its, mesh_);
        const Statistics& statistics = reconstructor_->statistics();
        told_.take(number, MadePart(number, particles.count(), statistics, outcome), mesh_);
        // Where one process makes many parts, the largest decides its memory: those are dealt by particles alone.
        if (pace_ == Pace::beside_a_simulation) making_.insert_or_assign(number, surface_loads());
        borders_.insert_or_assign(number, PartBorder(number, outcome.seams, mesh_, own_));
        report_.whole.peak_bytes = std::max(report_.whole.peak_bytes, statistics.peak_bytes);
        report_.whole.device_peak_bytes = std::max(report_.whole.device_peak_bytes, statistics.device_peak_bytes);
        report_.whole.backend = statistics.backend;
        report_.whole.threads = statistics.threads;
        sink({number, its, mesh_, statistics});
    }

    /// The triangles of the part that was made last, by brick. A part of many bricks is cut into runs of them, and one
    /// brick of each run has all the run's triangles: the message to all processes has a bound.
    std::vector<BrickLoad> surface_loads() const {
        const std::span<const MeshBrick> bricks(mesh_.bricks);
        const std::size_t group = bricks.size() / bricks_for_deal + 1;
        std::vector<BrickLoad> loads;
        for (std::size_t first = 0; first < bricks.size(); first += group) {
            const std::size_t end = std::min(first + group, bricks.size());
            BrickLoad load{bricks[(first + end) / 2].coordinate, static_cast<std::uint32_t>(agreement_.rank()), 0, 0};
            for (std::size_t b = first; b < end; ++b) load.triangles += bricks[b].triangle_count();
            loads.push_back(load);
        }
        return loads;
    }

    void rethrow_error() {
        if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    }

    /// Of all parts: those whose seams differ are wanted again. Returns what each process tells, PartsTold.
    std::vector<PartExchange::Bytes> compare() {
        agreement_.all_to_all(to_touching_, from_touching_, [&] {
            rethrow_error();
            to_touching_.resize(agreement_.ranks());
            write_contacts(borders_, rank_of_, to_touching_);
        });
        std::vector<PartExchange::Bytes> told = agreement_.gather([&] {
            told_.take(compare_contacts(borders_, from_touching_));
            return told_.packed();
        });
        agreement_.agree([&] {
            UnequalSeams unequal;
            for (const PartExchange::Bytes& message : told) PartsTold::add_unequal(message, unequal);
            report_.parts_made += wanted_.size();
            report_.unequal_seams += unequal.count;
            wanted_ = std::move(unequal.parts);
            std::sort(wanted_.begin(), wanted_.end());
            wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
            for (const std::size_t part : wanted_) {
                // Such a part has settled the whole frame.
                if (overlaps_[part] == max_overlap)
                    throw ProcessFailed("part " + std::to_string(part) +
                                        " fits to its neighbors at no overlap: all processes of a frame must run the "
                                        "same version with the same settings");
                overlaps_[part] = std::min(2 * overlaps_[part], max_overlap);
            }
        });
        return told;
    }

    /// What is quickly done: the rest is for report().
    void finish(std::vector<PartExchange::Bytes> told) {
        // A part that could not be made would seem to be no work: only finished frames count.
        surfaces_.swap(making_);
        report_.greatest_overlap = *std::max_element(overlaps_.begin(), overlaps_.end());
        Statistics& whole = report_.whole;
        whole.particles = facts_.particles();
        whole.particle_volume = volume_of(facts_.by_level, settings_);
        whole.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (agreement_.ranks() == 1) whole.warnings = warnings_here();
        finished_ = {std::move(report_), std::move(told)};
    }

    /// Of the whole frame, which this process alone has.
    std::vector<Warning> warnings_here() const {
        const MadePart sum = told_.sum();
        Statistics figures;
        for (const std::uint64_t triangles : sum.triangles_by_level) figures.triangles += triangles;
        figures.spray_particles = sum.spray_particles;
        find_warnings(
            PlacedFrame(mine_), facts_.by_level, settings_, wrong_radius_, [&] { return sum.greatest_sample; },
            figures);
        return std::move(figures.warnings);
    }

    Settings settings_;
    PartsOptions options_;
    Agreement agreement_;
    AttributeChoice choice_;
    std::optional<Reconstructor> reconstructor_;  ///< of a maker
    Mesh mesh_;

    // Of the frame that has begun:
    std::chrono::steady_clock::time_point start_;
    PartParticles kept_;
    ParticleFrame mine_;  ///< borrows from the caller, and from what is kept
    Pace pace_ = Pace::at_once;
    ParticlesNear near_;
    FrameFacts facts_;
    std::vector<BrickBox> own_;
    std::vector<std::size_t> rank_of_;  ///< that makes each part
    std::vector<std::uint32_t> overlaps_;
    std::optional<Warning> wrong_radius_;
    PartsReport report_;                                            ///< without what is summed up of the parts
    PartsTold told_;                                                ///< by this process
    std::map<std::size_t, std::vector<BrickLoad>> making_;          ///< the triangles of these
    std::map<std::size_t, std::vector<BrickLoad>> surfaces_;        ///< the last finished frame's, for the next deal
    Borders borders_;                                               ///< of its parts
    std::vector<PartExchange::Bytes> to_touching_, from_touching_;  ///< of these, to the parts beyond
    // Of the round:
    std::vector<std::size_t> wanted_;  ///< the parts to make, in all processes
    std::vector<std::vector<std::size_t>> of_rank_;
    std::vector<std::size_t> mine_to_make_;
    std::size_t turns_ = 0, turn_ = 0;
    std::vector<PartExchange::Bytes> to_, from_;  ///< the particles for this turn's parts
    PartParticles particles_;
    std::exception_ptr error_;  ///< of make()

    /// Of the frame that has ended last:
    struct {
        PartsReport report;
        std::vector<PartExchange::Bytes> told;  ///< by each process, PartsTold
    } finished_;
};

PartsReconstructor::PartsReconstructor(const Settings& settings, const BackendOptions& backend,
                                       const PartsOptions& options, PartExchange& exchange)
    : impl_(std::make_unique<Impl>(settings, backend, options, exchange)) {}
PartsReconstructor::~PartsReconstructor() = default;

PartsReport PartsReconstructor::reconstruct(const ParticleFrame& mine, const PartSink& sink) {
    impl_->begin([&mine] { return HandedFrame(mine, true, true); }, Impl::Pace::at_once);
    do make(sink);
    while (go_on());
    return report();
}

void PartsReconstructor::begin(const FrameGiver& mine) {
    impl_->begin(mine, Impl::Pace::beside_a_simulation);
}

void PartsReconstructor::make(const PartSink& sink) noexcept {
    impl_->make(sink);
}

bool PartsReconstructor::go_on() {
    return impl_->go_on();
}

PartsReport PartsReconstructor::report() const {
    return impl_->report();
}

}  // namespace meniscus
