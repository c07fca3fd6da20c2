#include "ranks/parts_job.hpp"

#include <algorithm>
#include <random>

#include "meniscus/client/errors.hpp"
#include "meniscus/error.hpp"
#include "ranks/agreed.hpp"
#include "ranks/files_publisher.hpp"
#include "ranks/session_publisher.hpp"

namespace meniscus::ranks {
namespace {

/// The number of a first run, which is not 0, and above it room for those that follow.
std::uint64_t drawn_run() {
    std::random_device random;
    return (std::uint64_t{random()} << 16) + 1;
}

std::unique_ptr<PartsPublisher> make_publisher(const PartsArguments& arguments) {
    if (arguments.output.empty()) return std::make_unique<SessionPublisher>(arguments);
    return std::make_unique<FilesPublisher>(arguments.output);
}

}  // namespace

PartsJob::PartsJob(PartExchange& exchange, bool leads_node, const text_options::Options& options)
    : exchange_(exchange) {
    std::optional<PartsArguments> arguments;
    const std::vector<std::string> all = agreed(exchange_, [&] {
        arguments = parts_arguments(options);
        publisher_ = make_publisher(*arguments);
        return std::to_string(drawn_run()) + (leads_node ? "+" : "-") + arguments->common;
    });
    std::vector<bool> lead_nodes;
    std::vector<std::string> options_of;
    for (const std::string& its : all) {
        const std::size_t sign = its.find_first_of("+-");
        lead_nodes.push_back(its[sign] == '+');
        options_of.push_back(its.substr(sign + 1));
        // Known to all: all throw.
        if (options_of.back() != options_of.front())
            throw InvalidInput("rank " + std::to_string(options_of.size() - 1) + " has the options " +
                               options_of.back() + ", and rank 0 has " + options_of.front() +
                               ": all must have the same, but for the server, the connection and the backend");
    }
    const std::vector<std::size_t> makers = ranks_of(arguments->makers, lead_nodes);
    agreed(exchange_, [&] {
        live_.emplace(arguments->settings, arguments->backend, PartsOptions{makers.size(), arguments->overlap, makers},
                      arguments->policy, exchange_, *publisher_);
        return std::string();
    });
    open_session(makers, std::stoull(all[0]));
}

void PartsJob::open_session(const std::vector<std::size_t>& makers, std::uint64_t run) {
    const auto own = std::find(makers.begin(), makers.end(), exchange_.rank());
    is_maker_ = own != makers.end();
    const auto number = static_cast<std::size_t>(own - makers.begin());
    const auto open = [&] { return publisher_->open({number, makers.size(), run, session_id_}); };
    session_id_ = agreed(exchange_, [&] { return number == 0 ? open() : std::string(); })[makers[0]];
    agreed(exchange_, [&] { return is_maker_ && number != 0 ? open() : std::string(); });
}

template <class Call>
auto PartsJob::in_words_of_server(const Call& call) {
    try {
        return call();
    } catch (const PublishingFailed& failure) {
        if (session_id_.empty()) throw;
        throw client::ServerError(failure.what(), client::ErrorCode::unavailable);
    }
}

bool PartsJob::push(const FrameGiver& mine, std::uint64_t index, double simulation_time) {
    // The same in all ranks.
    if (is_finished_) throw InvalidInput("the frames are finished: push others to parts that are opened anew");
    return in_words_of_server([&] { return live_->push(mine, index, simulation_time); });
}

void PartsJob::finish_others() noexcept {
    try {
        if (is_maker_) publisher_->finish();
    } catch (...) {
        // One failure has been told.
    }
}

void PartsJob::finish() {
    is_finished_ = true;
    try {
        in_words_of_server([&] { live_->finish(); });
    } catch (...) {
        finish_others();
        throw;
    }
    agreed(exchange_, [&] {
        if (is_maker_) publisher_->finish();
        return std::string();
    });
}

}  // namespace meniscus::ranks
