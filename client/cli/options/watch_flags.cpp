#include "cli/options/watch_flags.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "cli/options/attribute_bits.hpp"
#include "cli/options/codec_option.hpp"
#include "cli/options/normal_bits.hpp"
#include "cli/options/normals_by.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/seconds_option.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

constexpr std::string_view every_attribute = "all";
constexpr std::string_view no_attribute = "none";

std::string names_of(const std::vector<std::string>& attributes) {
    if (attributes.empty()) return "none";
    std::string names;
    for (const std::string& name : attributes) names += (names.empty() ? "" : ", ") + name;
    return names;
}

std::vector<AttributeWish> requests_for(const std::vector<std::string>& names, int bits, const Settings& settings) {
    if (names.empty() || names == std::vector<std::string>{std::string(every_attribute)})
        return {{.name = {}, .bits = bits}};
    if (names == std::vector<std::string>{std::string(no_attribute)}) return {};
    std::vector<AttributeWish> requests;
    for (const std::string& name : names) {
        if (name == every_attribute || name == no_attribute)
            throw InvalidInput("--attribute " + name + " stands alone: leave the other names out");
        // If a session has all attributes, their names come with its first frame.
        if (!settings.all_attributes && std::ranges::find(settings.attributes, name) == settings.attributes.end())
            throw InvalidInput("--attribute " + name + ": the session's attributes are " +
                               names_of(settings.attributes));
        requests.push_back({.name = name, .bits = bits});
    }
    return requests;
}

}  // namespace

void WatchFlags::add_form_to(CLI::App& command, const std::string& heading, const std::string& codec_otherwise,
                             const std::string& attributes_otherwise) {
    const OptionGroup group(command, heading);
    add_normal_bits(command, normal_bits, "")->default_str(std::to_string(options.normal_bits));
    add_normals_by(command, options.normals_by);
    command
        .add_option("--attribute", attributes, "Attribute that the meshes carry, once for each; all, or none of them")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->default_str(attributes_otherwise);
    add_attribute_bits(command, attribute_bits);
    command
        .add_option(
            "--position-bits", options.position_bits,
            "Vertices lie on multiples of the cell size / 2^BITS, 2 or more; fewer bits take fewer bytes. Default: as "
            "reconstructed")
        ->check(CLI::Range(2, 8));
    add_codec(command, options.codec, codec_otherwise);
    command.add_option("--max-level", options.max_level, "Finest level of grid, 1 to 3: a coarser surface, as closed")
        ->check(CLI::Range(1, 3))
        ->capture_default_str();
}

void WatchFlags::add_to(CLI::App& command) {
    constexpr const char* heading = "What is sent";
    add_form_to(command, heading, "packed from this machine, entropy from others and in files of bricks", "all");
    const OptionGroup group(command, heading);
    command.add_option("--region", region, "X0 Y0 Z0 X1 Y1 Z1: only bricks that touch this box, world units")
        ->expected(6);
    command
        .add_option("--bytes-per-second", options.bytes_per_second,
                    "Bandwidth in the mean, such as 2MB: frames are skipped to keep it; 0: no limit")
        ->transform(CLI::AsSizeValue(false))
        ->capture_default_str();
    command.add_option("--viewpoint", viewpoint, "X Y Z: the nearest bricks are sent first, world units")->expected(3);
    add_seconds(command, "--reconnect", options.reconnect,
                "Seconds for which a broken connection or a restarting server is tried again; 0: no retries")
        ->check(number_range(0.0, 1e6))
        ->default_str("0");
}

client::WatchOptions WatchFlags::build(const Settings& settings) const {
    client::WatchOptions out = options;
    out.normal_bits = normal_bits.value_or(out.normal_bits);
    if (!region.empty()) out.region = Box{{region[0], region[1], region[2]}, {region[3], region[4], region[5]}};
    if (!viewpoint.empty()) out.viewpoint = {viewpoint[0], viewpoint[1], viewpoint[2]};
    out.attributes = requests_for(attributes, attribute_bits, settings);
    return out;
}

}  // namespace meniscus::cli
