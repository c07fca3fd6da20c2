// The program meniscusd in a process of its own, and what it costs.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

class ServerProgram {
public:
    /// Starts it on a Unix socket and waits until it listens. Throws std::runtime_error if it does not.
    ServerProgram(const std::string& program, const std::vector<std::string>& options);
    ~ServerProgram();  ///< ends it
    ServerProgram(const ServerProgram&) = delete;
    ServerProgram& operator=(const ServerProgram&) = delete;

    const std::string& address() const noexcept { return address_; }
    /// Processor time of all its threads so far, seconds.
    double processor_seconds() const;

private:
    std::string address_;
    pid_t pid_ = -1;
};

/// The flag that names it.
void add_meniscusd_option(CLI::App& command, std::string& program);

/// Processor time of all threads of this process so far, seconds.
double processor_seconds();

}  // namespace meniscus::benchmarks
