#include "server_program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "meniscus/client/client.hpp"
#include "processor_time.hpp"

namespace meniscus::benchmarks {

namespace {

pid_t start(std::vector<std::string> command) {
    std::vector<char*> argv;
    argv.reserve(command.size() + 1);
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t pid = -1;
    const int error = ::posix_spawnp(&pid, argv.front(), nullptr, nullptr, argv.data(), environ);
    if (error != 0)
        throw std::runtime_error("cannot run " + command.front() + ": " + std::strerror(error) +
                                 "; --meniscusd says where it is");
    return pid;
}

bool listens(const std::string& address) {
    try {
        return client::Client(address).serving();
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace

ServerProgram::ServerProgram(const std::string& program, const std::vector<std::string>& options)
    : address_("unix:" +
               (std::filesystem::temp_directory_path() / ("meniscus-bench-" + std::to_string(::getpid()))).string()) {
    std::vector<std::string> command{program, "--listen", address_};
    command.insert(command.end(), options.begin(), options.end());
    pid_ = start(std::move(command));
    while (!listens(address_)) {
        if (::waitpid(pid_, nullptr, WNOHANG) != 0) throw std::runtime_error(program + " ended before it listened");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

ServerProgram::~ServerProgram() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
}

double ServerProgram::processor_seconds() const {
    clockid_t clock{};
    if (::clock_getcpuclockid(pid_, &clock) != 0) throw std::runtime_error("meniscusd has ended");
    return clock_seconds(clock);
}

void add_meniscusd_option(CLI::App& command, std::string& program) {
    command.add_option("--meniscusd", program, "The program; looked for in PATH if it is a name alone")
        ->capture_default_str();
}

double processor_seconds() {
    return clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace meniscus::benchmarks
