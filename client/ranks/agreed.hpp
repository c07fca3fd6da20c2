// The words of all ranks while a job opens and ends; an error of one of them is thrown by all.
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

/// The words that body() returns in each rank. An error of one is thrown by all.
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
