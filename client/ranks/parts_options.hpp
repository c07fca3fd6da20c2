// The options of parts of frames that ranks make together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/live_parts.hpp"
#include "meniscus/settings.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::ranks {

/// Which ranks reconstruct.
struct Makers {
    bool of_nodes = true;   ///< one of each machine
    std::size_t count = 0;  ///< where not `of_nodes`: the number of ranks, 0 for all
};

struct PartsArguments {
    std::string server;
    std::string output;  ///< a folder of files in place of the server; empty: none
    text_options::Options connection;
    text_options::Options session;  ///< and of its publisher, with the settings
    Settings settings;
    BackendOptions backend;
    LivePolicy policy = LivePolicy::latest;
    std::uint32_t overlap = default_overlap;
    Makers makers;
    CodingOptions coding;  ///< of the bricks, but for the attributes
    std::vector<AttributeWish> wishes;
    std::string common;  ///< the options that all ranks have the same, as NAME=VALUE: not where one is or connects
};

/// The options that are of parts alone.
void read_parts_options(text_options::OptionReader& options, PartsArguments& arguments);

/// Throws InvalidInput for an option that is wrong, unknown here, or of what the ranks agree on.
PartsArguments parts_arguments(const text_options::Options& options);

/// leads_node: of each rank. Throws InvalidInput for more makers than ranks.
std::vector<std::size_t> ranks_of(const Makers& makers, const std::vector<bool>& leads_node);

}  // namespace meniscus::ranks
