// The flag --max-file-bytes.
#pragma once

namespace CLI {
class App;
}

namespace meniscus::formats {
struct ReadLimits;
}

namespace meniscus::cli {

/// limits: outlives the parsing; its present value is the default.
void add_read_limits(CLI::App& command, formats::ReadLimits& limits);

}  // namespace meniscus::cli
