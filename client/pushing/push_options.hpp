// The options of a connection, of a session and of a publisher as arguments of `meniscus push`.
#pragma once

#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/settings.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::pushing {

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

/// How a publisher encodes its bricks, here.
struct PublishedForm {
    CodingOptions coding;  ///< but for the attributes
    std::vector<AttributeWish> wishes;
};
struct PublishArguments {
    PushArguments push;
    PublishedForm form;
};
/// Of a publisher. Throws likewise.
PublishArguments publish_arguments(const std::string& address, const text_options::Options& connection,
                                   const text_options::Options& session);

}  // namespace meniscus::pushing
