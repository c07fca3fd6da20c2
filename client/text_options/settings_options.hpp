// The settings of a reconstruction as options: every row of the table in client/README.md#settings.
#pragma once

#include "meniscus/settings.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::text_options {

/// Throws InvalidInput for an option that is wrong or would change nothing, and for settings out of range.
Settings read_settings(OptionReader& options);

}  // namespace meniscus::text_options
