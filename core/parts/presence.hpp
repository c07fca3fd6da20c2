// What processes that push frames together say before each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/parts.hpp"
#include "parts/message.hpp"

namespace meniscus {

struct Presence {
    std::uint64_t index = 0;
    double simulation_time = 0.0;
    bool ends = false;  ///< no frame follows
    bool is_at_work = false;
    bool is_away = false;   ///< its publisher
    std::string failure{};  ///< of its publisher; empty: none
};

inline PartExchange::Bytes packed(const Presence& presence) {
    MessageWriter message;
    message.add(presence.index);
    message.add(presence.simulation_time);
    message.add(presence.ends);
    message.add(presence.is_at_work);
    message.add(presence.is_away);
    message.add_text(presence.failure);
    return message.take();
}

inline Presence unpacked_presence(const PartExchange::Bytes& bytes) {
    MessageReader message(bytes);
    Presence presence;
    presence.index = message.get<std::uint64_t>();
    presence.simulation_time = message.get<double>();
    presence.ends = message.get<bool>();
    presence.is_at_work = message.get<bool>();
    presence.is_away = message.get<bool>();
    presence.failure = message.get_text();
    return presence;
}

inline std::string text_of(const Presence& presence) {
    return presence.ends ? "ends"
                         : "pushes frame " + std::to_string(presence.index) + " at time " +
                               std::to_string(presence.simulation_time);
}

/// Throws the same in all processes.
inline void require_one_frame(const std::vector<Presence>& all) {
    for (std::size_t rank = 1; rank < all.size(); ++rank)
        if (all[rank].ends != all[0].ends || all[rank].index != all[0].index ||
            all[rank].simulation_time != all[0].simulation_time)
            throw InvalidInput("rank " + std::to_string(rank) + " " + text_of(all[rank]) + ", and rank 0 " +
                               text_of(all[0]) + ": all must do the same");
}

}  // namespace meniscus
