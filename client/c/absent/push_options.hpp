// The options of a connection and of a session as arguments of `meniscus push`.
#pragma once

#include <string>
#include <vector>

#include "meniscus/settings.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::c {

/// Throws InvalidInput for an option that is wrong or not of a connection.
void check_connection(const text_options::Options& connection);

struct PushArguments {
    std::vector<std::string> words;
    std::string token;  ///< not among the words, which other users of the machine see
    Settings settings;
};
/// connection: checked before. Throws InvalidInput for an option that is wrong or not of a session, NotBuilt for what
/// `meniscus push` cannot do.
PushArguments push_arguments(const std::string& address, const text_options::Options& connection,
                             const text_options::Options& session);

}  // namespace meniscus::c
