#include "cli/commands/reconstruct_report.hpp"

#include <unistd.h>

#include <iostream>
#include <utility>

#include "cli/print/listener.hpp"
#include "cli/print/statistics_text.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/point_writer.hpp"
#include "formats/meshes/pvd_writer.hpp"
#include "formats/meshes/usda_writer.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

ReconstructReport::ReconstructReport(const ReconstructFiles& files, const Plan& plan, const ReportOptions& options)
    : files_(files),
      plan_(plan),
      options_(options),
      bar_(plan.frames.size(),
           options_.bar && plan.frames.size() > 1 && !options_.verbosity.quiet && !options_.verbosity.verbose),
      warnings_(options_.strict) {
    if (options_.verbosity.quiet) return;
    bar_.erase();
    const std::size_t frames = plan_.frames.size() + plan_.skipped;
    if (files_.share)
        std::cerr << "share " << files_.share->text() << ": " << frames << " of " << plan_.all.size() << " frames\n";
    if (plan_.skipped != 0)
        std::cerr << plan_.skipped << " of " << frames << " frames skipped: their files are there\n";
}

FinishedFrame ReconstructReport::prepare(Surface& surface, std::size_t index, std::vector<Statistics> runs) const {
    FinishedFrame frame;
    frame.index = index;
    frame.runs = std::move(runs);
    if (!files_.spray_out.empty()) frame.spray.assign(surface.spray().begin(), surface.spray().end());
    if (!files_.stats.empty()) {
        frame.hashes = MeshHashes(surface.mesh());
        frame.attributes = attributes_json(surface.mesh());
    }
    if (!files_.out.empty() || options_.check)
        frame.mesh.emplace(surface, plan_.format, options_.edits, options_.check);
    return frame;
}

void ReconstructReport::deliver(FinishedFrame finished) {
    const FrameFiles& frame = plan_.frames[finished.index];
    if (!frame.out.empty())
        finished.mesh->write(frame.out,
                             plan_.sequence ? std::optional(static_cast<double>(frame.number)) : std::nullopt);
    if (!files_.usd_stage.empty()) form_ = finished.mesh->form();
    if (!frame.spray_out.empty())
        formats::write_points(frame.spray_out, finished.spray, options_.edits.origin.value_or(editing::Origin{}));
    if (!files_.stats.empty()) {
        nlohmann::ordered_json figures;
        if (plan_.sequence) figures["frame"] = frame.number;
        figures.update(to_json(finished.runs, finished.hashes));
        figures["attributes"] = std::move(finished.attributes);
        for (const FileWarning& warning : finished.warnings) figures["warnings"].push_back(to_json(warning));
        figures_.push_back(std::move(figures));
    }
    bar_.erase();
    say(frame, finished);
    bar_.advance();
}

void ReconstructReport::say_run(std::size_t run, std::size_t runs, const Statistics& statistics) const {
    if (runs == 1 || options_.verbosity.quiet || !(options_.verbosity.verbose || isatty(STDERR_FILENO) != 0)) return;
    std::cerr << "run " << run << " of " << runs << ": " << statistics.total_seconds << " s\n";
}

void ReconstructReport::write_usd_stage() const {
    std::vector<formats::UsdaClip> clips;
    for (const FrameFiles& frame : plan_.all) clips.push_back({static_cast<double>(frame.number), frame.out});
    formats::write_usda_clips(files_.usd_stage, clips, *form_);
}

void ReconstructReport::say(const FrameFiles& frame, const FinishedFrame& finished) {
    const std::string name = formats::input_name(frame.in);
    const Statistics& statistics = median_run(finished.runs);
    for (const FileWarning& warning : finished.warnings) warnings_.say(name, warning);
    warnings_.say(name, statistics.warnings);
    if (finished.mesh && finished.mesh->defects())
        check_.say(frame.out.empty() ? name : formats::output_name(frame.out), *finished.mesh->defects());
    if (options_.verbosity.quiet || bar_.is_drawn()) return;
    std::cerr << name << ": " << summary(statistics);
    for (const auto& path : {frame.out, frame.spray_out})
        if (!path.empty()) std::cerr << ", " << formats::output_name(path);
    std::cerr << '\n';
    if (options_.verbosity.verbose) std::cerr << stages_text(statistics);
    require_listener();
}

void ReconstructReport::finish() {
    bar_.erase();
    if (bar_.is_drawn()) {
        std::cerr << plan_.frames.size() << " frames, " << bar_.seconds() << " s";
        for (const std::string& pattern : {files_.out, files_.spray_out})
            if (!pattern.empty()) std::cerr << ", " << pattern;
        std::cerr << '\n';
    }
    if (!files_.stats.empty()) {
        nlohmann::ordered_json all = nlohmann::ordered_json::object();
        if (plan_.sequence)
            all["frames"] = figures_;
        else if (!figures_.empty())
            all = figures_.at(0);
        formats::write_file(files_.stats, all.dump(2) + "\n");
    }
    if (!files_.pvd.empty()) {
        std::vector<formats::PvdEntry> entries;
        for (const FrameFiles& frame : plan_.all) entries.push_back({static_cast<double>(frame.number), frame.out});
        formats::write_pvd(files_.pvd, entries);
    }
    if (!files_.usd_stage.empty()) write_usd_stage();
    check_.finish();
    warnings_.finish();
}

}  // namespace meniscus::cli
