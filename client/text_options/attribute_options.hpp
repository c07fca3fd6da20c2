// The options of attributes: which ones, and how exactly they travel.
#pragma once

#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/settings.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::text_options {

/// "attribute" of the settings: names, or all.
void read_attributes(OptionReader& options, Settings& settings);

/// "attribute" and "attribute-bits" of a watcher; a name may have bits of its own, as in "velocity:12".
std::vector<AttributeWish> read_attribute_wishes(OptionReader& options);

/// "attribute-bits" of a publisher.
int read_attribute_bits(OptionReader& options);

/// "attribute-bits" of a session: its stream gets back whatever attributes it has.
std::vector<AttributeWish> read_every_attribute(OptionReader& options);

}  // namespace meniscus::text_options
