// Parts in rounds: all are made, then those whose seams differ once more with twice the overlap, until none does.
#include <algorithm>
#include <chrono>
#include <map>
#include <string>

#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/reconstructor.hpp"
#include "particles/attribute_choice.hpp"
#include "particles/seams.hpp"
#include "particles/validation.hpp"
#include "particles/warnings.hpp"
#include "parts/compare_seams.hpp"
#include "parts/frame_facts.hpp"
#include "parts/made_part.hpp"
#include "parts/message.hpp"
#include "parts/part_particles.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus {
std::vector<PartExchange::Bytes> AloneExchange::gather(Bytes mine) {
    std::vector<Bytes> all;
    all.push_back(std::move(mine));
    return all;
}

class PartsReconstructor::Impl {
public:
    Impl(const Settings& settings, const BackendOptions& backend, const PartsOptions& options, PartExchange& exchange)
        : reconstructor_(settings, backend), options_(options), exchange_(exchange), choice_(settings) {
        deal_bricks({}, options.parts);
        FramePart part;
        part.overlap = options.overlap;
        validate(part);
    }

    PartsReport reconstruct(const ParticleFrame& given, const PartSink& sink) {
        // As a Reconstructor does, which passes over arrays that the frames before did not bring.
        validate_lengths(given);
        const std::vector<ParticleArray> arrays = choice_.of(given);
        validate_places(given, settings());
        ParticleFrame mine = given;
        mine.sent = nullptr;
        mine.arrays = arrays;
        const FrameFacts facts = facts_together(exchange_.gather(packed(facts_of(mine))));
        // All processes hold the next frames against the same arrays, also one that has brought none.
        choice_.keep(facts.form.without_values());

        own_ = deal_bricks(facts.loads, options_.parts);
        overlaps_.assign(own_.size(), options_.overlap);
        seams_.clear();
        made_.clear();
        borders_.clear();
        report_ = {};
        const auto start = std::chrono::steady_clock::now();
        std::vector<std::size_t> wanted(own_.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
        while (!wanted.empty()) {
            make(wanted, facts, mine, sink);
            report_.parts_made += wanted.size();
            const UnequalSeams unequal = compare_seams(all_seams(), own_);
            report_.unequal_seams += unequal.count;
            wanted = unequal.parts;
            for (const std::size_t part : wanted) overlaps_[part] = std::min(2 * overlaps_[part], max_overlap);
        }
        report_.greatest_overlap = *std::max_element(overlaps_.begin(), overlaps_.end());
        finish_report(facts, mine);
        report_.whole.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return report_;
    }

private:
    const Settings& settings() const { return reconstructor_.settings(); }

    FrameFacts facts_of(const ParticleFrame& mine) const {
        FrameFacts facts;
        facts.form = FrameForm(mine);
        facts.by_level = count_levels(mine);
        facts.loads = brick_loads(mine, settings());
        facts.ranges = array_ranges(mine, settings());
        return facts;
    }

    std::size_t rank_of(std::size_t part) const { return part * exchange_.ranks() / own_.size(); }

    /// One part of each process at a time: of the particles near it there is one copy beside the frame.
    void make(const std::vector<std::size_t>& wanted, const FrameFacts& facts, const ParticleFrame& mine,
              const PartSink& sink) {
        std::vector<std::vector<std::size_t>> of_rank(exchange_.ranks());
        std::size_t turns = 0;
        for (const std::size_t part : wanted) {
            std::vector<std::size_t>& its = of_rank[rank_of(part)];
            its.push_back(part);
            turns = std::max(turns, its.size());
        }
        for (std::size_t turn = 0; turn < turns; ++turn) {
            std::vector<PartExchange::Bytes> to(exchange_.ranks());
            for (std::size_t rank = 0; rank < to.size(); ++rank)
                if (turn < of_rank[rank].size())
                    to[rank] = particles_within(
                        mine, reach_of(part(of_rank[rank][turn], facts), settings(), facts.coarsest_level()));
            std::vector<PartExchange::Bytes> from = exchange_.all_to_all(std::move(to));
            if (turn >= of_rank[exchange_.rank()].size()) continue;
            PartParticles particles(facts.form);
            for (PartExchange::Bytes& bytes : from) {
                particles.add(bytes);
                bytes = {};
            }
            make_one(of_rank[exchange_.rank()][turn], facts, particles.frame(), sink);
        }
    }

    FramePart part(std::size_t number, const FrameFacts& facts) const {
        return {own_[number], overlaps_[number], facts.ranges};
    }

    void make_one(std::size_t number, const FrameFacts& facts, const ParticleFrame& particles, const PartSink& sink) {
        const FramePart its = part(number, facts);
        PartOutcome outcome = reconstructor_.reconstruct_part(particles, its, mesh_);
        const Statistics& statistics = reconstructor_.statistics();
        made_[number] = MadePart(particles.count(), statistics, outcome);
        seams_[number] = std::move(outcome.seams);
        borders_[number] = border_vertices(mesh_, its.own);
        report_.whole.peak_bytes = std::max(report_.whole.peak_bytes, statistics.peak_bytes);
        report_.whole.device_peak_bytes = std::max(report_.whole.device_peak_bytes, statistics.device_peak_bytes);
        report_.whole.backend = statistics.backend;
        report_.whole.threads = statistics.threads;
        sink({number, its, mesh_, statistics});
    }

    /// All processes' values.
    template <class T>
    std::vector<T> gathered(const std::vector<T>& mine) {
        MessageWriter message;
        message.add_all(std::span<const T>(mine));
        std::vector<T> all;
        for (const PartExchange::Bytes& bytes : exchange_.gather(message.take())) MessageReader(bytes).append_to(all);
        return all;
    }

    std::vector<PartSeam> all_seams() {
        std::vector<PartSeam> mine;
        for (const auto& [number, seams] : seams_)
            for (const Seam& seam : seams) mine.push_back({seam, number});
        return gathered(mine);
    }

    /// The number of vertices that a border's parts have more than once.
    std::uint64_t repeated_vertices() {
        std::vector<LatticePosition> mine;
        for (const auto& [number, vertices] : borders_) mine.insert(mine.end(), vertices.begin(), vertices.end());
        std::vector<LatticePosition> all = gathered(mine);
        std::sort(all.begin(), all.end());
        return static_cast<std::uint64_t>(all.end() - std::unique(all.begin(), all.end()));
    }

    void finish_report(const FrameFacts& facts, const ParticleFrame& mine) {
        std::vector<MadePart> parts;
        for (const auto& [number, figures] : made_) parts.push_back(figures);
        MadePart sum;
        for (const MadePart& part : gathered(parts)) sum.add(part);
        report_.particles_received = sum.particles;
        Statistics& whole = report_.whole;
        whole.particles = facts.particles();
        whole.particle_volume = volume_of(facts.by_level, settings());
        whole.vertices = sum.vertices - repeated_vertices();
        whole.triangles_by_level = sum.triangles_by_level;
        for (const std::uint64_t triangles : sum.triangles_by_level) whole.triangles += triangles;
        whole.base_cells_by_level = sum.base_cells_by_level;
        whole.volume = world_volume(sum.sixfold_volume, world_cell_size(settings()), offset_bits(settings()));
        whole.spray_particles = sum.spray_particles;
        whole.vertices_without_particles = sum.vertices_without_particles;
        whole.field_evaluations = sum.field_evaluations;
        whole.stage_seconds = sum.stage_seconds;
        if (exchange_.ranks() != 1) return;
        // The whole frame is here.
        const PlacedFrame placed(mine);
        find_warnings(
            placed, facts.by_level, settings(), find_wrong_radius(placed, settings()),
            [&] { return sum.greatest_sample; }, whole);
    }

    Reconstructor reconstructor_;
    PartsOptions options_;
    PartExchange& exchange_;
    AttributeChoice choice_;
    Mesh mesh_;
    std::vector<BrickBox> own_;
    std::vector<std::uint32_t> overlaps_;
    std::map<std::size_t, std::vector<Seam>> seams_;  ///< of this process's parts, by number
    std::map<std::size_t, MadePart> made_;
    std::map<std::size_t, std::vector<LatticePosition>> borders_;  ///< see border_vertices()
    PartsReport report_;
};

PartsReconstructor::PartsReconstructor(const Settings& settings, const BackendOptions& backend,
                                       const PartsOptions& options, PartExchange& exchange)
    : impl_(std::make_unique<Impl>(settings, backend, options, exchange)) {}
PartsReconstructor::~PartsReconstructor() = default;

PartsReport PartsReconstructor::reconstruct(const ParticleFrame& mine, const PartSink& sink) {
    return impl_->reconstruct(mine, sink);
}

}  // namespace meniscus
