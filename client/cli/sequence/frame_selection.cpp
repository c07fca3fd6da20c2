#include "cli/sequence/frame_selection.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

#include "cli/options/option_group.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// CLI11's own takes -1 for 2^64 - 1, or names the range in floating point, to its 309 digits.
CLI::Validator whole_number_from(std::uint64_t least) {
    return {[least](const std::string& text) -> std::string {
                std::uint64_t number = 0;
                const char* const last = text.data() + text.size();
                const auto [end, error] = std::from_chars(text.data(), last, number);
                if (error == std::errc() && end == last && number >= least) return {};
                return text + " not in range " + std::to_string(least) + " to " +
                       std::to_string(std::numeric_limits<std::uint64_t>::max());
            },
            ""};
}

}  // namespace

void FrameSelection::add_range_to(CLI::App& command) {
    const OptionGroup group(command, sequence_heading);
    const CLI::Validator not_negative = whole_number_from(0).description("NONNEGATIVE");
    command.add_option("--start", start, "First frame (default: the first that is there)")->check(not_negative);
    command.add_option("--end", end, "Last frame (default: the last that is there)")->check(not_negative);
}

void FrameSelection::add_to(CLI::App& command) {
    add_range_to(command);
    const OptionGroup group(command, sequence_heading);
    const CLI::Validator positive = whole_number_from(1).description("POSITIVE");
    command.add_option("--step", step, "One of this many frame numbers, from the first frame on")
        ->check(positive)
        ->capture_default_str();
    command.add_flag("--skip-missing", skip_missing,
                     "Leave out frames from --start to --end that are not there, in place of refusing them");
}

std::vector<NumberedFile> FrameSelection::files(FilePattern& pattern) const {
    if (start && end && *start > *end)
        throw InvalidInput("--start " + std::to_string(*start) + " is beyond --end " + std::to_string(*end));
    auto there = pattern.match_existing();
    const std::uint64_t least = start.value_or(0);
    const std::uint64_t most = end.value_or(std::numeric_limits<std::uint64_t>::max());
    std::erase_if(there, [&](const auto& file) { return file.first < least || file.first > most; });
    const std::string range =
        (start ? " from " + std::to_string(*start) : "") + (end ? " to " + std::to_string(*end) : "");
    if (there.empty())
        throw InvalidInput(pattern.text() + ": no such file" + (range.empty() ? "" : " (frames" + range + ")"));

    std::vector<NumberedFile> selected;
    const auto refuse_missing = [&](std::uint64_t number) {
        throw InvalidInput(pattern.at(number).string() + ": no such file (frame " + std::to_string(number) +
                           " of those" + range + "); --skip-missing leaves out what is not there");
    };
    if (start && end && !skip_missing) {
        for (std::uint64_t number = *start;; number += step) {
            const auto file = there.find(number);
            if (file == there.end()) refuse_missing(number);
            selected.push_back({number, file->second});
            if (*end - number < step) return selected;
        }
    }
    for (const auto& named : {start, end})
        if (named && !skip_missing && !there.contains(*named)) refuse_missing(*named);
    const std::uint64_t first = start.value_or(there.begin()->first);
    for (const auto& [number, path] : there)
        if ((number - first) % step == 0) selected.push_back({number, path});
    if (selected.empty())
        throw InvalidInput(pattern.text() + ": none of the files" + (range.empty() ? "" : " of frames" + range) +
                           " is a --step of " + std::to_string(step) + " from frame " + std::to_string(first));
    return selected;
}

}  // namespace meniscus::cli
