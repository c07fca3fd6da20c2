// The server under attack.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../soak/process_size.hpp"

namespace meniscus::hostile {

struct TargetOptions {
    std::vector<std::string> arguments;  ///< beside --listen and --http, which are on free ports of loopback
    std::optional<rlim_t> descriptors;   ///< its limit, soft and hard
    std::string listen = "127.0.0.1:0";  ///< address; that of an earlier server for one that takes its place
};

/// How a server ended.
struct End {
    double seconds = 0.0;  ///< time from SIGTERM on
    int exit_code = 0;     ///< 128 + the signal that has killed it
};

/// meniscusd in a process of its own, which goes with this process.
class Target {
public:
    /// Returns once it listens. Throws std::runtime_error if it does not.
    explicit Target(const std::string& program, TargetOptions options = {});
    ~Target();  ///< kills it where it has not been ended
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    const std::string& address() const noexcept { return address_; }            ///< HOST:PORT of gRPC
    const std::string& http_address() const noexcept { return http_address_; }  ///< HOST:PORT of HTTP
    pid_t process() const noexcept { return process_; }
    soak::ProcessSize size() const { return soak::process_size(process_); }
    std::size_t peak_bytes() const;    ///< the most that has been resident, files and shared memory with it
    double processor_seconds() const;  ///< processor time of all its threads so far

    /// Sends SIGTERM and waits for its end.
    End terminate();

private:
    void wait_until_it_listens();
    std::optional<std::string> line();

    pid_t process_ = -1;
    int output_ = -1;
    std::string buffer_;  ///< output that is not a whole line yet
    std::string address_;
    std::string http_address_;
    std::thread reader_;  ///< reads the output after the addresses, so that the server never waits for a reader
};

}  // namespace meniscus::hostile
