// The command line as a whole: parsing, dispatch and exit codes.
#pragma once

namespace meniscus::cli {

/// What the process answers.
enum ExitCode : int {
    success = 0,
    failure = 1,    ///< anything that is not the caller's fault
    bad_input = 2,  ///< arguments, files, settings, or a server that is not there
};

/// Runs `meniscus`. Whatever goes wrong is one line on stderr.
int run(int argc, const char* const* argv);

}  // namespace meniscus::cli
