#include "ranks/parts_options.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "meniscus/error.hpp"
#include "text_options/backend_options.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"

namespace meniscus::ranks {
namespace {

using text_options::OptionReader;
using text_options::Options;

/// What read(reader) asks for, of these.
template <class Read>
Options some_of(const Options& options, const Read& read) {
    OptionReader reader(&options);
    read(reader);
    Options some;
    for (const std::string& name : reader.known())
        if (const auto option = options.find(name); option != options.end()) some.insert(*option);
    return some;
}

/// Throws for what the ranks agree on by themselves.
void refuse_of_ranks(const Options& options) {
    constexpr std::array<std::string_view, 4> names{"parts", "part", "run", "nth"};
    for (const std::string_view name : names)
        if (options.find(name) != options.end())
            throw InvalidInput("option '" + std::string(name) + "' is not known here: the ranks agree on it");
}

/// Throws unless frames go to one place.
void require_one_place(const PartsArguments& arguments) {
    if (arguments.server.empty() && arguments.output.empty())
        throw InvalidInput("option 'server' is not set, must be HOST:PORT; or 'output', a folder of files");
    if (!arguments.server.empty() && !arguments.output.empty())
        throw InvalidInput("options 'server' and 'output' are both set, must be one of them");
}

/// Throws for what files have no place for.
void refuse_of_sessions(const PartsArguments& arguments) {
    if (arguments.settings.spray == Spray::points)
        throw InvalidInput(
            "option 'spray' is 'points', which the files of 'output' have no place for: must be keep or discard");
    OptionReader settings(&arguments.session);
    text_options::read_settings(settings);
    for (const Options* const options : {&arguments.connection, &arguments.session})
        for (const auto& option : *options)
            if (std::ranges::find(settings.known(), option.first) == settings.known().end())
                throw InvalidInput("option '" + option.first +
                                   "' is of servers, and 'output' writes files: leave it out");
}

}  // namespace

void read_parts_options(OptionReader& options, PartsArguments& arguments) {
    options.read("server", arguments.server);
    options.read("output", arguments.output);
    options.read("overlap", arguments.overlap);
    if (const std::string* const ranks = options.find("reconstruct-ranks")) {
        arguments.makers.of_nodes = *ranks == "node";
        if (*ranks == "node" || *ranks == "all") return;
        options.read("reconstruct-ranks", arguments.makers.count);
        if (arguments.makers.count == 0)
            throw InvalidInput("option 'reconstruct-ranks' is '0', must be node, all, or a number from 1 on");
    }
}

PartsArguments parts_arguments(const Options& options) {
    refuse_of_ranks(options);
    PartsArguments out;
    OptionReader reader(&options);
    read_parts_options(reader, out);
    require_one_place(out);
    out.backend = text_options::read_backend(reader);
    out.backend.keep_lattice = out.output.empty();  // for the codec
    client::PublisherOptions publisher;
    out.connection = some_of(options, [](OptionReader& some) { text_options::read_connection(some); });
    out.session = some_of(options, [&](OptionReader& some) {
        out.settings = text_options::read_settings(some);
        text_options::read_open(some);
        publisher = text_options::read_publisher(some);
    });
    Options common = options;
    common.erase("server");
    for (const Options& own : {out.connection, some_of(options, text_options::read_backend)})
        for (const auto& option : own) common.erase(option.first);
    for (const auto& [name, value] : common)
        out.common.append(out.common.empty() ? "" : " ").append(name).append("=").append(value);
    const bool has_policy = out.session.erase("policy") != 0;
    if (publisher.policy == client::UploadPolicy::every_nth)
        throw InvalidInput("option 'policy' is 'every-nth', must be latest or every-frame");
    if (has_policy && publisher.policy == client::UploadPolicy::every_frame) out.policy = LivePolicy::every_frame;
    if (!out.output.empty()) refuse_of_sessions(out);
    out.coding.normal_bits = publisher.normal_bits;
    out.coding.codec = publisher.codec;
    out.wishes = {{{}, publisher.attribute_bits}};
    text_options::read_connection(reader);
    text_options::read_settings(reader);
    text_options::read_open(reader);
    text_options::read_publisher(reader);
    reader.finish();
    return out;
}

std::vector<std::size_t> ranks_of(const Makers& makers, const std::vector<bool>& leads_node) {
    const std::size_t ranks = leads_node.size();
    std::vector<std::size_t> chosen;
    if (makers.of_nodes) {
        for (std::size_t rank = 0; rank < ranks; ++rank)
            if (leads_node[rank]) chosen.push_back(rank);
        if (chosen.empty())
            throw InvalidInput("exchange->leads_node is 0 in all ranks, must be 1 in one of each machine");
        return chosen;
    }
    if (makers.count > ranks)
        throw InvalidInput("option 'reconstruct-ranks' is " + std::to_string(makers.count) + ", must be at most the " +
                           std::to_string(ranks) + " ranks that there are");
    const std::size_t count = makers.count == 0 ? ranks : makers.count;
    // As far from each other as they can be: neighbors in number share a machine.
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * ranks / count);
    return chosen;
}

}  // namespace meniscus::ranks
