// What all ranks tell each other while a job opens and ends; what one of them throws, all throw.
#pragma once

#include <concepts>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "meniscus/client/errors.hpp"
#include "meniscus/parts.hpp"

namespace meniscus::ranks {

/// Words of one rank, or the error that it has in their place.
struct Told {
    std::string words;
    bool is_error = false;
    client::ErrorCode code{};  ///< of an error
};
/// Those of all ranks. Throws the first rank's error that has one, with its number: InvalidInput, LimitExceeded,
/// ProcessFailed where its code is unknown, and client::ServerError for all others.
std::vector<std::string> tell_all(PartExchange& exchange, const Told& mine);

/// Those that body() returns in each rank. What it throws in one is thrown in all.
template <std::invocable Body>
std::vector<std::string> agreed(PartExchange& exchange, const Body& body) {
    Told mine;
    try {
        mine.words = body();
    } catch (const std::bad_alloc&) {
        mine = {"not enough memory is left", true, client::ErrorCode::out_of_memory};
    } catch (const std::exception& error) {
        mine = {error.what(), true, client::code_of(error)};
    }
    return tell_all(exchange, mine);
}

}  // namespace meniscus::ranks
