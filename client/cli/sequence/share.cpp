#include "cli/sequence/share.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "cli/options/option_group.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::cli {
namespace {

/// More processes than any cluster starts, and few enough to multiply.
constexpr std::uint64_t most_shares = 1'000'000'000;

/// Where a scheduler says which of its processes this is.
struct Variables {
    const char* number;  ///< from `first` on
    const char* first;   ///< null: 0
    const char* step;    ///< null: 1
    const char* of;
    bool says_nothing_alone = false;  ///< the number, where there is no count
};

// Tasks of jobs, which are started one by one.
constexpr std::array tasks{
    Variables{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT"},
    Variables{"JOB_COMPLETION_INDEX", nullptr, nullptr, "JOB_COMPLETIONS"},
};
// Processes of one task. What MPI starts goes first: Slurm may count the launcher's own processes. A batch script has a
// SLURM_PROCID, too, but no step.
constexpr std::array processes{
    Variables{"OMPI_COMM_WORLD_RANK", nullptr, nullptr, "OMPI_COMM_WORLD_SIZE"},
    Variables{"PMI_RANK", nullptr, nullptr, "PMI_SIZE"},
    Variables{"SLURM_PROCID", nullptr, nullptr, "SLURM_STEP_NUM_TASKS", true},
};

std::optional<std::uint64_t> whole_number(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<std::uint64_t> number_in(const Environment& environment, const char* name) {
    const char* const text = name != nullptr ? environment(name) : nullptr;
    if (text == nullptr) return std::nullopt;
    const auto number = whole_number(text);
    if (!number || *number > most_shares)
        throw InvalidInput("--share auto: " + std::string(name) + " is " + quoted(text) +
                           ", but must be a whole number of at most " + std::to_string(most_shares));
    return number;
}

/// The share by the first of these that is there.
template <std::size_t Count>
std::optional<Share> find(const std::array<Variables, Count>& all, const Environment& environment) {
    for (const Variables& each : all) {
        const auto number = number_in(environment, each.number);
        const auto of = number_in(environment, each.of);
        if (number && !of && !each.says_nothing_alone)
            throw InvalidInput("--share auto: " + std::string(each.number) + " is " + std::to_string(*number) +
                               ", and " + each.of + ", which says of how many, is not there");
        if (!number || !of) continue;
        const std::uint64_t first = number_in(environment, each.first).value_or(0);
        const std::uint64_t step = number_in(environment, each.step).value_or(1);
        if (*number < first || step == 0 || (*number - first) % step != 0 || (*number - first) / step >= *of)
            throw InvalidInput("--share auto: " + std::string(each.number) + " is " + std::to_string(*number) +
                               ", which is not one of the " + std::to_string(*of) + " that " + each.of + " says" +
                               (first != 0 ? ", counted from " + std::to_string(first) : ""));
        return Share{(*number - first) / step + 1, *of};
    }
    return std::nullopt;
}

std::string named(const Variables& variables) {
    return std::string(variables.number) + " with " + variables.of;
}

Share share_of_process(const Environment& environment) {
    const auto task = find(tasks, environment);
    const auto process = find(processes, environment);
    if (!task && !process) {
        std::string looked_for;
        for (const auto& each : tasks) looked_for += named(each) + ", ";
        for (const auto& each : processes) looked_for += named(each) + ", ";
        looked_for.resize(looked_for.size() - 2);
        throw InvalidInput("--share auto: no variable of the environment says which share this is (" + looked_for +
                           "): say --share I/N");
    }
    const Share outer = task.value_or(Share{});
    const Share inner = process.value_or(Share{});
    if (outer.of > most_shares / inner.of)
        throw InvalidInput("--share auto: " + std::to_string(outer.of) + " tasks of " + std::to_string(inner.of) +
                           " processes are more than " + std::to_string(most_shares));
    return {(outer.number - 1) * inner.of + inner.number, outer.of * inner.of};
}

}  // namespace

std::uint64_t Share::begin(std::uint64_t frames) const {
    return (number - 1) * (frames / of) + std::min(number - 1, frames % of);
}

Share parse_share(const std::string& text, const Environment& environment) {
    if (text == "auto") return share_of_process(environment);
    const std::size_t slash = text.find('/');
    const auto number = whole_number(text.substr(0, slash));
    const auto of = slash != std::string::npos ? whole_number(text.substr(slash + 1)) : std::nullopt;
    if (number && of && *number >= 1 && *number <= *of && *of <= most_shares) return {*number, *of};
    throw InvalidInput("--share is " + quoted(text) +
                       ", but must be I/N, the Ith of N parts with I from 1 to N and N of at most " +
                       std::to_string(most_shares) + ", or auto");
}

void refuse_share_of_one(const std::optional<Share>& share, const std::string& in) {
    if (share) throw InvalidInput("--share is a part of a sequence: it needs {} in IN, which is '" + in + "'");
}

void add_share_option(CLI::App& command, std::optional<Share>& share) {
    const OptionGroup group(command, sequence_heading);
    command
        .add_option_function<std::string>(
            "--share",
            [&share](const std::string& text) {
                share = parse_share(text, [](const char* name) { return std::getenv(name); });
            },
            "I/N: the Ith of N equal parts of the frames, for machines that share a sequence out; auto: by the "
            "variables of Slurm, Kubernetes, Open MPI or MPICH. Lists are written by the same command without it")
        ->type_name("I/N|auto");
}

}  // namespace meniscus::cli
