// The frames of a job's ranks, of which some make parts and publish them to a session or a folder that they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/live_parts.hpp"
#include "meniscus/parts.hpp"
#include "ranks/parts_options.hpp"
#include "ranks/parts_publisher.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::ranks {

/// One in each rank. All functions are called by all ranks together, in the same order; an error of one rank
/// is thrown by all, with its number.
class PartsJob {
public:
    /// exchange: must stay. leads_node: of one rank of each machine. options: of settings, backend, connection, session
    /// and publisher, and see PartsArguments. Throws InvalidInput for these, and what opening the session throws.
    PartsJob(PartExchange& exchange, bool leads_node, const text_options::Options& options);

    /// As LiveParts::push(), with client::ServerError in place of a session's PublishingFailed. mine: may throw.
    bool push(const FrameGiver& mine, std::uint64_t index, double simulation_time);
    /// Publishes what was pushed, and waits until the server has answered, or the files are listed. No frame may
    /// follow.
    void finish();
    /// Empty where files are written.
    const std::string& session_id() const { return session_id_; }
    std::uint64_t next_index() const { return live_->next_index(); }
    std::uint64_t dropped() const { return live_->dropped(); }

private:
    /// The first maker opens the session, and the others join it.
    void open_session(const std::vector<std::size_t>& makers, std::uint64_t run);
    /// The frames but that which has failed.
    void finish_others() noexcept;
    template <class Call>
    auto in_words_of_server(const Call& call);

    PartExchange& exchange_;
    std::unique_ptr<PartsPublisher> publisher_;
    std::optional<LiveParts> live_;  ///< goes first
    std::string session_id_;
    bool is_maker_ = false;
    bool is_finished_ = false;
};

}  // namespace meniscus::ranks
