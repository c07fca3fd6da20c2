#include <memory>
#include <optional>

#include "options.hpp"
#include "particles.hpp"
#include "rank_exchange.hpp"
#include "ranks/last_two.hpp"
#include "ranks/parts_job.hpp"
#include "result.hpp"

using namespace meniscus::c;

struct meniscus_parts {
    RankExchange exchange;
    meniscus::ranks::LastTwo<FrameBuffers> buffers;
    std::optional<meniscus::ranks::PartsJob> job;  ///< goes first: it borrows from the buffers

    explicit meniscus_parts(const meniscus_exchange* ranks) : exchange(ranks) {}
};

meniscus_result meniscus_parts_open(const meniscus_exchange* exchange, const meniscus_options* options,
                                    meniscus_parts** parts) {
    return guarded([&] {
        required(parts, "parts") = nullptr;
        auto made = std::make_unique<meniscus_parts>(exchange);
        made->job.emplace(made->exchange, made->exchange.leads_node(),
                          options == nullptr ? meniscus::text_options::Options() : options->values);
        *parts = made.release();
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_parts_push(meniscus_parts* parts, const meniscus_particles* particles, uint64_t step,
                                    double time) {
    return guarded([&] {
        meniscus_parts& pushed = required(parts, "parts");
        const auto frame = [&] { return read_frame(particles, pushed.buffers.next()); };
        return pushed.job->push(frame, step, time) ? MENISCUS_OK : MENISCUS_WOULD_WAIT;
    });
}

meniscus_result meniscus_parts_free(meniscus_parts* parts) {
    if (parts == nullptr) return MENISCUS_OK;
    const meniscus_result result = guarded([&] {
        parts->job->finish();
        return MENISCUS_OK;
    });
    const RankExchange exchange = parts->exchange;
    delete parts;
    exchange.release();
    return result;
}

const char* meniscus_parts_session_id(const meniscus_parts* parts) {
    return parts == nullptr ? nullptr : parts->job->session_id().c_str();
}

meniscus_result meniscus_parts_dropped(const meniscus_parts* parts, uint64_t* frames) {
    return guarded([&] {
        required(frames, "frames") = required(parts, "parts").job->dropped();
        return MENISCUS_OK;
    });
}
