// Options of the C interface.
#pragma once

#include "meniscus/meniscus.h"
#include "text_options/option_reader.hpp"

struct meniscus_options {
    meniscus::text_options::Options values;
};

namespace meniscus::c {

/// options: may be null, for none.
inline text_options::OptionReader reader_of(const meniscus_options* options) {
    return text_options::OptionReader(options == nullptr ? nullptr : &options->values);
}

}  // namespace meniscus::c
