// What a server answers to a stream of frames, for programs: a line of JSON for each.
#pragma once

#include <cstdint>
#include <exception>
#include <fstream>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::cli {

/// Each line is written at once.
class AnswerLines {
public:
    /// path: "-" is standard output; empty: nothing is written. Throws InvalidInput if it cannot be written.
    explicit AnswerLines(const std::string& path);

    // All throw InvalidInput where nobody reads them any more, or the disk is full.
    void session(const std::string& id);
    /// dropped: frames that the policy has left out so far.
    void frame(const client::ReceivedFrame& frame, std::uint64_t dropped);
    /// The last line, here and below.
    void end(std::uint64_t dropped);
    void error(const std::exception& error, client::ErrorCode code);

private:
    void write(const std::string& line);

    std::string path_;
    std::ofstream file_;
};

}  // namespace meniscus::cli
