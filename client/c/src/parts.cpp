#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "failure.hpp"
#include "options.hpp"
#include "particles.hpp"
#include "parts_options.hpp"
#include "parts_publisher.hpp"
#include "rank_exchange.hpp"
#include "result.hpp"

using namespace meniscus::c;

struct meniscus_parts {
    RankExchange exchange;
    std::optional<PartsPublisher> publisher;
    std::optional<meniscus::LiveParts> live;  ///< goes first
    std::string session_id;
    FrameBuffers buffers;
    bool is_maker = false;

    explicit meniscus_parts(const meniscus_exchange* ranks) : exchange(ranks) {}
};

namespace {

/// The number of a first run, which is not 0, and above it room for those that follow.
std::uint64_t drawn_run() {
    std::random_device random;
    return (std::uint64_t{random()} << 16) + 1;
}

/// The first maker opens the session, and the others join it.
void open_session(meniscus_parts& parts, const std::vector<std::size_t>& makers, std::uint64_t run) {
    const auto own = std::find(makers.begin(), makers.end(), parts.exchange.rank());
    parts.is_maker = own != makers.end();
    const auto number = static_cast<std::size_t>(own - makers.begin());
    const auto open = [&] {
        parts.publisher->open(number, makers.size(), run, parts.session_id);
        return parts.publisher->session_id();
    };
    parts.session_id = parts.exchange.told([&] { return number == 0 ? open() : std::string(); })[makers[0]];
    parts.exchange.told([&] { return parts.is_maker && number != 0 ? open() : std::string(); });
}

void open(meniscus_parts& parts, const meniscus_options* options) {
    std::optional<PartsArguments> arguments;
    const std::vector<std::string> all = parts.exchange.told([&] {
        arguments = parts_arguments(options == nullptr ? meniscus::text_options::Options() : options->values);
        parts.publisher.emplace(*arguments);
        return std::to_string(drawn_run()) + (parts.exchange.leads_node() ? "+" : "-");
    });
    std::vector<bool> leads_node;
    for (const std::string& its : all) leads_node.push_back(its.back() == '+');
    const std::vector<std::size_t> makers = ranks_of(arguments->makers, leads_node);
    parts.exchange.told([&] {
        parts.live.emplace(arguments->settings, arguments->backend,
                           meniscus::PartsOptions{makers.size(), arguments->overlap, makers}, arguments->policy,
                           parts.exchange, *parts.publisher);
        return std::string();
    });
    open_session(parts, makers, std::stoull(all[0]));
}

void finish(meniscus_parts& parts) {
    parts.live->finish();
    parts.exchange.told([&] {
        if (parts.is_maker) parts.publisher->finish();
        return std::string();
    });
}

}  // namespace

meniscus_result meniscus_parts_open(const meniscus_exchange* exchange, const meniscus_options* options,
                                    meniscus_parts** parts) {
    return guarded([&] {
        required(parts, "parts") = nullptr;
        auto made = std::make_unique<meniscus_parts>(exchange);
        open(*made, options);
        *parts = made.release();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_parts_push(meniscus_parts* parts, const meniscus_particles* particles, uint64_t step,
                                    double time) {
    return guarded([&] {
        meniscus_parts& pushed = required(parts, "parts");
        const auto frame = [&] { return read_frame(particles, pushed.buffers); };
        return pushed.live->push(frame, step, time) ? MENISCUS_OK : MENISCUS_WOULD_WAIT;
    });
}

meniscus_result meniscus_parts_free(meniscus_parts* parts) {
    if (parts == nullptr) return MENISCUS_OK;
    const meniscus_result result = guarded([&] {
        finish(*parts);
        return MENISCUS_OK;
    });
    const RankExchange exchange = parts->exchange;
    delete parts;
    exchange.release();
    return result;
}

const char* meniscus_parts_session_id(const meniscus_parts* parts) {
    return parts == nullptr ? nullptr : parts->session_id.c_str();
}

meniscus_result meniscus_parts_dropped(const meniscus_parts* parts, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(parts, "parts").live->dropped();
        return MENISCUS_OK;
    });
}
