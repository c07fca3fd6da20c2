// The results of a run, as JSON for programs and as a table for people.
#pragma once

#include <string>

#include "load/load.hpp"

namespace meniscus::load {

/// Times in seconds, sizes in bytes.
std::string to_json(const LoadOptions& options, const LoadResult& result);
std::string to_table(const LoadResult& result);

/// Whether anything failed or was lost.
bool has_failures(const LoadResult& result);

}  // namespace meniscus::load
