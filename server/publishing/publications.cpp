#include "publishing/publications.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "files/publication_window.hpp"
#include "process/call_log.hpp"
#include "process/log.hpp"

namespace meniscus::server {

namespace {

/// Often enough that a segment ends soon after its time.
constexpr std::chrono::milliseconds tidying_interval{250};

/// Hands a session's meshes to its publication, on the thread that has encoded them. Each costs a copy of what has
/// changed and a hash of it, far less than its encoding.
class SessionPublication final : public SessionObserver {
public:
    SessionPublication(Publications& all, std::shared_ptr<Publication> publication, SessionIdentity identity)
        : all_(all),
          publication_(std::move(publication)),
          id_(std::move(identity.id)),
          turn_(publication_->begin(identity.kind.description)) {}

    /// Also of a session that could not be made.
    ~SessionPublication() override { end(); }

    Codec codec() const noexcept override { return Codec::lattice_entropy; }
    const char* product() const noexcept override { return "publication"; }
    void reconstructed(const InputFrame& /*frame*/) noexcept override {}
    void encoded(std::shared_ptr<const EncodedFrame> frame) noexcept override {
        try {
            publication_->add(turn_, *frame, Publication::Clock::now());
            all_.make_room();
        } catch (const std::exception& error) {
            if (!std::exchange(said_so_, true))
                log_warning({.session = id_, .frame = frame->index},
                            "the frame is not published, and others may not be: {}", error.what());
        }
    }
    void ended() noexcept override { end(); }

private:
    void end() noexcept {
        try {
            publication_->end(turn_, Publication::Clock::now());
        } catch (const std::exception& error) {
            log_warning({.session = id_}, "its last frames are not published: {}", error.what());
        }
    }

    Publications& all_;
    const std::shared_ptr<Publication> publication_;
    const std::string id_;
    const std::uint64_t turn_;
    bool said_so_ = false;  ///< in the log
};

}  // namespace

Publications::Publications(const PublishingOptions& options, std::size_t most_ended)
    : options_(options), most_ended_(most_ended) {
    timer_.every(tidying_interval, [this] {
        try {
            tidy(Publication::Clock::now());
        } catch (const std::exception& error) {
            spdlog::error("publications: {}", error.what());
        }
    });
}

std::shared_ptr<SessionObserver> Publications::observe(const SessionIdentity& identity, const Settings& settings) {
    call_log.write({.session = identity.id}, "published under /publications/{}/", identity.id);
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(identity.id);
    std::shared_ptr<Publication> publication = found != entries_.end() ? found->second : nullptr;
    if (!publication || publication->owner() != identity.owner || publication->settings() != settings) {
        publication = std::make_shared<Publication>(identity.owner, settings, options_, counters_);
        entries_.insert_or_assign(identity.id, publication);
    }
    return std::make_shared<SessionPublication>(*this, publication, identity);
}

bool Publications::remove(const std::string& session_id, const std::function<bool(const std::string& owner)>& may) {
    std::shared_ptr<Publication> removed;  // which goes without the lock
    {
        const std::lock_guard lock(mutex_);
        const auto found = entries_.find(session_id);
        if (found == entries_.end() || !may(found->second->owner())) return false;
        removed = std::move(found->second);
        entries_.erase(found);
    }
    call_log.write({.session = session_id}, "is not published any more: its publication was deleted");
    return true;
}

std::shared_ptr<const Publication> Publications::find(std::string_view session_id) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(session_id);
    return found != entries_.end() ? found->second : nullptr;
}

std::size_t Publications::count() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

void Publications::make_room() {
    if (options_.limit == 0 || counters_->held <= options_.limit) return;
    const std::lock_guard lock(mutex_);
    struct Held {
        std::size_t bytes;
        std::size_t* of_owner;               ///< of all of its owner
        Publication::Clock::duration ended;  ///< -1: its session lives
        Publication* publication;
        auto goes_first() const { return std::tuple(*of_owner, bytes != 0, ended, bytes); }
    };
    const auto now = Publication::Clock::now();
    std::vector<Held> held;
    std::map<std::string_view, std::size_t> of_owners;
    std::size_t all = 0;
    for (const auto& [id, publication] : entries_) {
        held.push_back({publication->bytes(), &of_owners[publication->owner()],
                        publication->ended_for(now).value_or(Publication::Clock::duration(-1)), publication.get()});
        *held.back().of_owner += held.back().bytes;
        all += held.back().bytes;
    }
    while (all > options_.limit) {
        Held& from = *std::ranges::max_element(held, {}, &Held::goes_first);
        from.publication->drop_oldest();
        const std::size_t before = std::exchange(from.bytes, from.publication->bytes());
        *from.of_owner += from.bytes - before;
        all += from.bytes - before;
    }
}

bool Publications::may_be_sent() const noexcept {
    return options_.limit == 0 || counters_->held <= options_.limit + options_.limit / 4;
}

void Publications::tidy(Publication::Clock::time_point now) {
    std::vector<std::shared_ptr<Publication>> all;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [id, publication] : entries_) all.push_back(publication);
    }
    // Without the lock: one may be writing a large frame.
    for (const auto& publication : all) publication->tidy(now);
    {
        const std::lock_guard lock(mutex_);
        forget_ended(now);
    }
    make_room();
}

void Publications::forget_ended(Publication::Clock::time_point now) {
    struct Ended {
        Publication::Clock::duration time;
        Entries::iterator entry;
        std::size_t* of_owner;  ///< how many its owner has
    };
    std::vector<Ended> ended;
    std::map<std::string, std::size_t> of_owners;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        const auto time = entry->second->ended_for(now);
        // Readers look at the manifest once more, to see the end.
        const bool is_over = time && (options_.keep.count() != 0 ? *time >= std::max<Publication::Clock::duration>(
                                                                                options_.keep, files::readers_delay)
                                                                 : entry->second->bytes() == 0);
        if (time && !is_over) {
            ended.push_back({*time, entry, &of_owners[entry->second->owner()]});
            ++*ended.back().of_owner;
        }
        entry = is_over ? entries_.erase(entry) : std::next(entry);
    }
    while (ended.size() > most_ended_) {
        const auto goes =
            std::ranges::max_element(ended, {}, [](const Ended& each) { return std::pair(*each.of_owner, each.time); });
        --*goes->of_owner;
        entries_.erase(goes->entry);
        ended.erase(goes);
    }
}

}  // namespace meniscus::server
