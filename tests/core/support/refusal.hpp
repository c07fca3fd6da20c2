// The words in which a call refuses.
#pragma once

#include <string>

#include "meniscus/error.hpp"

namespace meniscus::test {

/// The message of the error that the call throws; empty if it throws none. Other errors pass through.
template <class Error = InvalidInput, class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const Error& refused) {
        return refused.what();
    }
    return {};
}

}  // namespace meniscus::test
