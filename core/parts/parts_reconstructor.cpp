// Parts in rounds: all are made, then those whose seams differ once more with twice the overlap, until none does.
#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
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
#include "parts/brick_loads.hpp"
#include "parts/contacts.hpp"
#include "parts/dealt_frame.hpp"
#include "parts/frame_facts.hpp"
#include "parts/made_part.hpp"
#include "parts/part_particles.hpp"
#include "parts/parts_told.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus {
namespace {

/// Of a process beside a simulation, which are looked at for the deal: it has one part at most, and the parts' shares
/// are even to some percent.
constexpr std::size_t particles_for_deal = 1024;
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
        pace_ = pace;
        coming_.start = std::chrono::steady_clock::now();
        coming_.told = agreement_.gather([&] {
            HandedFrame handed = give();
            // As a Reconstructor does, which passes over arrays that the frames before did not bring.
            validate_lengths(handed.frame);
            const std::vector<ParticleArray> chosen = choice_.of(handed.frame);
            handed.frame.sent = nullptr;
            handed.frame.arrays = chosen;
            coming_.mine = coming_.kept.keep(handed);
            validate_places(coming_.mine, settings_);
            return packed(facts_of(coming_.mine));
        });
    }

    void prepare() noexcept {
        try {
            coming_.error = nullptr;
            coming_.prepare(settings_, options_);
        } catch (...) {
            coming_.error = std::current_exception();
        }
    }

    void bring() {
        std::swap(frame_, coming_);
        told_ = {};
        borders_.clear();
        making_.clear();
        report_ = {};
        send([this] {
            rethrow_error();
            // All processes hold the next frames against the same arrays, also one that has brought none.
            choice_.keep(frame_.facts.form.without_values());
        });
    }

    void make(const PartSink& sink) noexcept {
        const std::size_t* const number = frame_.part_of(agreement_.rank());
        if (number == nullptr) return;
        try {
            // Here, for it goes through all particles; where one process has them all.
            if (agreement_.ranks() == 1 && frame_.turn() == 0 && report_.parts_made == 0)
                wrong_radius_ = find_wrong_radius(PlacedFrame(frame_.mine), settings_);
            particles_.begin(frame_.facts.form);
            for (PartExchange::Bytes& bytes : from_) {
                particles_.add(bytes);
                // The frames of a simulation follow each other in the same memory: new pages cost more than copies.
                // (`bytes = {}` would keep the memory.)
                if (pace_ == Pace::at_once) PartExchange::Bytes().swap(bytes);
            }
            make_one(*number, particles_.frame(), sink);
        } catch (...) {
            frame_.error = std::current_exception();
        }
    }

    bool go_on() {
        if (!frame_.begin_next_turn()) {
            std::vector<PartExchange::Bytes> told = compare();
            if (frame_.wanted().empty()) {
                finish(std::move(told));
                return false;
            }
        }
        send([this] {
            rethrow_error();
            frame_.write(settings_);
        });
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

    /// prepare: what this process does before, and may throw.
    template <class Prepare>
    void send(const Prepare& prepare) {
        agreement_.all_to_all(frame_.messages(), from_, prepare);
        if (pace_ == Pace::at_once) frame_.messages().clear();
    }

    void make_one(std::size_t number, const ParticleFrame& particles, const PartSink& sink) {
        const FramePart its = frame_.part(number);
        const PartOutcome outcome = reconstructor_->reconstruct_part(particles, its, mesh_);
        const Statistics& statistics = reconstructor_->statistics();
        told_.take(number, MadePart(number, particles.count(), statistics, outcome), mesh_);
        // Where one process makes many parts, the largest decides its memory: those are dealt by particles alone.
        if (pace_ == Pace::beside_a_simulation)
            making_.insert_or_assign(
                number, surface_loads(mesh_, static_cast<std::uint32_t>(agreement_.rank()), bricks_for_deal));
        borders_.insert_or_assign(number, PartBorder(number, outcome.seams, mesh_, frame_.own()));
        report_.whole.peak_bytes = std::max(report_.whole.peak_bytes, statistics.peak_bytes);
        report_.whole.device_peak_bytes = std::max(report_.whole.device_peak_bytes, statistics.device_peak_bytes);
        report_.whole.backend = statistics.backend;
        report_.whole.threads = statistics.threads;
        sink({number, its, mesh_, statistics});
    }

    void rethrow_error() {
        if (frame_.error) std::rethrow_exception(std::exchange(frame_.error, nullptr));
    }

    /// Of all parts: those whose seams differ are wanted again. Returns what each process tells, PartsTold.
    std::vector<PartExchange::Bytes> compare() {
        agreement_.all_to_all(to_touching_, from_touching_, [&] {
            rethrow_error();
            to_touching_.resize(agreement_.ranks());
            write_contacts(borders_, frame_.rank_of(), to_touching_);
        });
        std::vector<PartExchange::Bytes> told = agreement_.gather([&] {
            told_.take(compare_contacts(borders_, from_touching_));
            return told_.packed();
        });
        agreement_.agree([&] {
            UnequalSeams unequal;
            for (const PartExchange::Bytes& message : told) PartsTold::add_unequal(message, unequal);
            report_.parts_made += frame_.wanted().size();
            report_.unequal_seams += unequal.count;
            frame_.make_again(std::move(unequal.parts));
        });
        return told;
    }

    /// What is quickly done: the rest is for report().
    void finish(std::vector<PartExchange::Bytes> told) {
        // A part that could not be made would seem to be no work: only finished frames count.
        surfaces_.swap(making_);
        report_.greatest_overlap = frame_.greatest_overlap();
        Statistics& whole = report_.whole;
        whole.particles = frame_.facts.particles();
        whole.particle_volume = volume_of(frame_.facts.by_level, settings_);
        whole.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - frame_.start).count();
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
            PlacedFrame(frame_.mine), frame_.facts.by_level, settings_, wrong_radius_,
            [&] { return sum.greatest_sample; }, figures);
        return std::move(figures.warnings);
    }

    Settings settings_;
    PartsOptions options_;
    Agreement agreement_;
    AttributeChoice choice_;
    std::optional<Reconstructor> reconstructor_;  ///< of a maker
    Mesh mesh_;

    Pace pace_ = Pace::at_once;

    DealtFrame coming_;  ///< has begun
    // Of the frame that has been brought:
    DealtFrame frame_;
    std::optional<Warning> wrong_radius_;
    PartsReport report_;                                            ///< without what is summed up of the parts
    PartsTold told_;                                                ///< by this process
    std::map<std::size_t, std::vector<BrickLoad>> making_;          ///< the surfaces of these
    std::map<std::size_t, std::vector<BrickLoad>> surfaces_;        ///< the last finished frame's, for the next deal
    Borders borders_;                                               ///< of its parts
    std::vector<PartExchange::Bytes> to_touching_, from_touching_;  ///< of these, to the parts beyond
    std::vector<PartExchange::Bytes> from_;                         ///< the particles for this turn's part
    PartParticles particles_;

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
    prepare();
    bring();
    do make(sink);
    while (go_on());
    return report();
}

void PartsReconstructor::begin(const FrameGiver& mine) {
    impl_->begin(mine, Impl::Pace::beside_a_simulation);
}

void PartsReconstructor::prepare() noexcept {
    impl_->prepare();
}

void PartsReconstructor::bring() {
    impl_->bring();
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
