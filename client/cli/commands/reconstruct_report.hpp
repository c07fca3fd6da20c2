// The files and lines that `meniscus reconstruct` writes, frame by frame.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/reconstruct_plan.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/print/progress_bar.hpp"
#include "cli/print/statistics_json.hpp"
#include "cli/print/warnings.hpp"
#include "cli/surfaces/mesh_check.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::cli {

/// The options of the report beside the files.
struct ReportOptions {
    Verbosity verbosity;
    bool strict = false;
    bool check = false;
    bool bar = true;  ///< where there is a terminal and more than one frame
    MeshEdits edits;
};

/// A frame that is done, but that nobody has seen yet.
struct FinishedFrame {
    std::size_t index = 0;  ///< among the plan's frames
    std::vector<Statistics> runs;
    std::vector<FileWarning> warnings;
    std::optional<MeshOutput> mesh;  ///< none: only figures are asked for
    std::vector<Point> spray;
    MeshHashes hashes;                  ///< empty: not asked for
    nlohmann::ordered_json attributes;  ///< ranges
};

class ReconstructReport {
public:
    ReconstructReport(const ReconstructFiles& files, const Plan& plan, const ReportOptions& options);

    /// Does the part of the work that takes time but shows nothing, in any thread. `warnings` stays empty.
    FinishedFrame prepare(Surface& surface, std::size_t index, std::vector<Statistics> runs) const;
    /// Writes the frame's files and says what there is to say: in order, one at a time.
    void deliver(FinishedFrame frame);
    /// One of the times that a frame is reconstructed, for --repeat.
    void say_run(std::size_t run, std::size_t runs, const Statistics& statistics) const;
    /// To be called once all frames are delivered. Throws Defective or Warned.
    void finish();

private:
    void write_usd_stage() const;
    void say(const FrameFiles& frame, const FinishedFrame& finished);

    const ReconstructFiles& files_;
    const Plan& plan_;
    const ReportOptions options_;
    ProgressBar bar_;
    Warnings warnings_;
    MeshCheck check_;
    std::optional<formats::TriangleMesh> form_;  ///< of the frame that was delivered last, for a stage of USD
    nlohmann::ordered_json figures_ = nlohmann::ordered_json::array();
};

}  // namespace meniscus::cli
