#include "ranks/agreed.hpp"

#include <cstddef>
#include <cstring>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::ranks {
namespace {

/// As they lie in memory: the ranks run the same program on machines of the same kind.
struct Head {
    bool is_error;
    client::ErrorCode code;
};

[[noreturn]] void fail(client::ErrorCode code, const std::string& message) {
    switch (code) {
        case client::ErrorCode::invalid_input:
            throw InvalidInput(message);
        case client::ErrorCode::limit_exceeded:
            throw LimitExceeded(message);
        case client::ErrorCode::unknown:
            throw ProcessFailed(message);
        default:
            throw client::ServerError(message, code);
    }
}

}  // namespace

std::vector<std::string> tell_all(PartExchange& exchange, const Told& mine) {
    const Head head{mine.is_error, mine.code};
    PartExchange::Bytes message(sizeof head + mine.words.size());
    std::memcpy(message.data(), &head, sizeof head);
    if (!mine.words.empty()) std::memcpy(message.data() + sizeof head, mine.words.data(), mine.words.size());
    std::vector<std::string> all;
    const std::vector<PartExchange::Bytes> messages = exchange.gather(std::move(message));
    for (std::size_t rank = 0; rank < messages.size(); ++rank) {
        Head its{};
        if (messages[rank].size() < sizeof its)
            throw ProcessFailed("rank " + std::to_string(rank) + ": it runs another version");
        std::memcpy(&its, messages[rank].data(), sizeof its);
        const auto* const text = reinterpret_cast<const char*>(messages[rank].data() + sizeof its);
        all.emplace_back(text, messages[rank].size() - sizeof its);
        if (its.is_error) fail(its.code, "rank " + std::to_string(rank) + ": " + all.back());
    }
    return all;
}

}  // namespace meniscus::ranks
