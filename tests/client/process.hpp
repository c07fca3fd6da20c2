// Runs the command line as a user does.
#pragma once

#include <string>
#include <vector>

namespace meniscus::test {

struct ProcessResult {
    int exit_code = -1;  ///< -1: ended by a signal
    std::string out;
    std::string err;
};

/// Runs `program` with these arguments and waits for its end.
ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace meniscus::test
