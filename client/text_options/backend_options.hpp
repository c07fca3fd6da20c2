// The options of where and how to compute.
#pragma once

#include "meniscus/backend_options.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::text_options {

BackendOptions read_backend(OptionReader& options);

}  // namespace meniscus::text_options
