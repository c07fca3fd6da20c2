#include "sessions/watching/watcher_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "sessions/limits/limit_reached.hpp"

namespace meniscus::server {

namespace {

/// Not all of many: the list goes into a status message, which gRPC limits to some kilobytes.
std::string described(const std::vector<AttributeWish>& attributes) {
    constexpr std::size_t most = 4;
    std::string list;
    for (std::size_t i = 0; i < std::min(most, attributes.size()); ++i)
        list += fmt::format("{} {} of {} bits", i == 0 ? ", attributes" : " and",
                            attributes[i].name.empty() ? "all others" : attributes[i].name, attributes[i].bits);
    if (attributes.size() > most) list += fmt::format(" and {} more", attributes.size() - most);
    return list;
}

std::string described(const std::set<WatchForm>& forms) {
    struct Description {
        std::string operator()(const MeshFormat& format) const {
            return fmt::format("(max_level {}, position_bits {}, normal_bits {}, codec {}{})", format.max_level,
                               format.position_bits, format.normal_bits, name_of(format.codec),
                               described(format.attributes));
        }
        std::string operator()(std::uint64_t max_particles) const {
            return fmt::format("(max_particles {})", max_particles);
        }
    };
    std::string list;
    for (const WatchForm& form : forms) list += (list.empty() ? "" : ", ") + std::visit(Description{}, form);
    return list;
}

}  // namespace

void require_room_for(const WatchOptions& options, const NameAccount* watcher,
                      std::vector<std::shared_ptr<Watch>> watches, const std::string& session, const Limits& limits) {
    std::erase_if(watches, [](const auto& watch) { return watch->options().once; });
    const auto is_of_the_name = [&](const auto& watch) { return watch->account().get() == watcher; };
    if (limits.watchers_per_session != 0 && watches.size() >= limits.watchers_per_session)
        throw LimitReached(LimitName::watchers,
                           fmt::format("session {} has {} watchers; the server takes at most {} per session", session,
                                       watches.size(), limits.watchers_per_session));
    const NameShares shares = watcher != nullptr ? watcher->shares() : NameShares{};
    if (shares.watchers != 0 && std::ranges::count_if(watches, is_of_the_name) >= std::ptrdiff_t{shares.watchers})
        throw LimitReached(LimitName::watchers_per_name,
                           fmt::format("{} has {} watchers of session {}; the server takes at most {} of one caller "
                                       "per session",
                                       watcher->name(), shares.watchers, session, shares.watchers));
    std::set<WatchForm> forms;
    std::set<WatchForm> forms_of_the_name;
    for (const auto& watch : watches) {
        forms.insert(watch->options().form());
        if (is_of_the_name(watch)) forms_of_the_name.insert(watch->options().form());
    }
    if (forms.contains(options.form())) return;
    if (limits.formats_per_session != 0 && forms.size() >= limits.formats_per_session)
        throw LimitReached(LimitName::formats,
                           fmt::format("the watchers of session {} have {} formats; the server takes at most {} per "
                                       "session: wish for one of {}",
                                       session, forms.size(), limits.formats_per_session, described(forms)));
    if (shares.formats != 0 && forms_of_the_name.size() >= shares.formats)
        throw LimitReached(
            LimitName::formats_per_name,
            fmt::format("the watchers of {} have {} formats of session {}; the server takes at most {} "
                        "of one caller per session: wish for one of {}",
                        watcher->name(), forms_of_the_name.size(), session, shares.formats, described(forms)));
}

}  // namespace meniscus::server
