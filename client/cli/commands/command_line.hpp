// The command line as a whole: parsing, dispatch and exit codes.
#pragma once

namespace meniscus::cli {

/// The process's exit status.
enum ExitCode : int {
    success = 0,
    failure = 1,    ///< an error that is not the caller's
    bad_input = 2,  ///< arguments, files, settings, or a server that is not there
    warned = 3,     ///< there were warnings, and --strict
    defective = 4,  ///< a mesh that was to be checked is not closed, manifold and oriented
};

/// Runs `meniscus`. Every error is one line on stderr.
int run(int argc, const char* const* argv);

}  // namespace meniscus::cli
