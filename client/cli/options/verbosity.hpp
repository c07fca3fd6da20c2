// The flags -q and -v: how much is said on stderr.
#pragma once

namespace CLI {
class App;
}

namespace meniscus::cli {

struct Verbosity {
    bool quiet = false;    ///< warnings and errors alone
    bool verbose = false;  ///< also what each step took

    void add_to(CLI::App& command);
    /// -q alone, where there is no more to say.
    void add_quiet_to(CLI::App& command);
};

}  // namespace meniscus::cli
