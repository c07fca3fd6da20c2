// One of several parts of a sequence, by which processes of a cluster share its frames out. None of them knows of the
// others: the parts depend on nothing but their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace meniscus::cli {

/// The part `number` of `of` parts, counted from 1.
struct Share {
    std::uint64_t number = 1;
    std::uint64_t of = 1;

    /// The place of its first frame, and that behind its last one, of this many frames. Parts differ by at most one
    /// frame.
    std::uint64_t begin(std::uint64_t frames) const;
    std::uint64_t end(std::uint64_t frames) const { return Share{number + 1, of}.begin(frames); }
    std::string text() const { return std::to_string(number) + " of " + std::to_string(of); }

    template <class Frame>
    void keep(std::vector<Frame>& frames) const {
        const auto place = [&](std::uint64_t at) { return frames.begin() + static_cast<std::ptrdiff_t>(at); };
        const std::uint64_t count = frames.size();
        frames.erase(place(end(count)), frames.end());
        frames.erase(frames.begin(), place(begin(count)));
    }
};

/// The value of an environment variable, or null.
using Environment = std::function<const char*(const char* name)>;

/// text: I/N, or auto, by the variables of schedulers and of MPI: the task of an array (Slurm) or of an Indexed Job
/// (Kubernetes), times the rank within it. Throws InvalidInput, naming what was looked for.
Share parse_share(const std::string& text, const Environment& environment);

/// Throws InvalidInput for a share of one file. in: its name, which has no {}.
void refuse_share_of_one(const std::optional<Share>& share, const std::string& in);

/// The flag --share.
void add_share_option(CLI::App& command, std::optional<Share>& share);

}  // namespace meniscus::cli
