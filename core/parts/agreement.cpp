#include "parts/agreement.hpp"

#include <new>
#include <string_view>

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

enum class Kind : std::uint8_t { no_failure, invalid_input, limit_exceeded, other };

PartExchange::Bytes message_of(Kind kind, std::string_view text) {
    PartExchange::Bytes bytes;
    bytes.reserve(text.size() + 1);
    for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
    bytes.push_back(static_cast<std::byte>(kind));
    return bytes;
}

[[noreturn]] void throw_from(std::size_t rank, Kind kind, std::span<const std::byte> words) {
    const std::string text =
        "rank " + std::to_string(rank) + ": " + std::string(reinterpret_cast<const char*>(words.data()), words.size());
    if (kind == Kind::invalid_input) throw InvalidInput(text);
    if (kind == Kind::limit_exceeded) throw LimitExceeded(text);
    throw ProcessFailed(text);
}

}  // namespace

Agreement::Bytes Agreement::failure_of(const std::exception_ptr& error) const {
    if (ranks() == 1) std::rethrow_exception(error);
    try {
        std::rethrow_exception(error);
    } catch (const InvalidInput& wrong) {
        return message_of(Kind::invalid_input, wrong.what());
    } catch (const LimitExceeded& wrong) {
        return message_of(Kind::limit_exceeded, wrong.what());
    } catch (const std::bad_alloc&) {
        return message_of(Kind::limit_exceeded, "not enough memory is left");
    } catch (const std::exception& wrong) {
        return message_of(Kind::other, wrong.what());
    } catch (...) {
        return message_of(Kind::other, "an exception that is none of this library's");
    }
}

void Agreement::open(std::vector<Bytes>& from) {
    for (std::size_t rank = 0; rank < from.size(); ++rank) {
        Bytes& bytes = from[rank];
        if (bytes.empty()) throw ProcessFailed("rank " + std::to_string(rank) + ": it runs another version");
        const auto kind = static_cast<Kind>(bytes.back());
        bytes.pop_back();
        if (kind != Kind::no_failure) throw_from(rank, kind, bytes);
    }
}

}  // namespace meniscus
