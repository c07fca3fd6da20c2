// Options as the C interface takes them.
#pragma once

#include "handles.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::catalyst {

/// The names are known: the options were read. Without memory the call that they are for fails.
inline COptions c_options(const text_options::Options& values) {
    meniscus_options* made = nullptr;
    meniscus_options_create(&made);
    COptions options(made);
    for (const auto& [name, value] : values) meniscus_options_set(made, name.c_str(), value.c_str());
    return options;
}

}  // namespace meniscus::catalyst
