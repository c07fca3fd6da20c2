// What a run has found: for programs as JSON, for people as a table.
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
