// A job under mpiexec, with pipes to and from its first rank.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace meniscus::test {

class MpiProcess {
public:
    /// command: the program and its arguments.
    MpiProcess(int ranks, std::vector<std::string> command) {
        // Open MPI runs neither as root nor more ranks than cores unless it is told to; other MPIs pass these over.
        ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
        ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        ::setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
        command.insert(command.begin(), {MENISCUS_MPIEXEC, "-n", std::to_string(ranks)});
        std::vector<char*> argv;
        argv.reserve(command.size() + 1);
        for (std::string& word : command) argv.push_back(word.data());
        argv.push_back(nullptr);
        int down[2];
        int up[2];
        EXPECT_EQ(::pipe2(down, O_CLOEXEC), 0);
        EXPECT_EQ(::pipe2(up, O_CLOEXEC), 0);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::dup2(down[0], STDIN_FILENO);
            ::dup2(up[1], STDOUT_FILENO);
            ::execv(MENISCUS_MPIEXEC, argv.data());
            ::_exit(127);
        }
        ::close(down[0]);
        ::close(up[1]);
        to_ = ::fdopen(down[1], "w");
        from_ = ::fdopen(up[0], "r");
    }
    ~MpiProcess() {
        end_input();
        std::fclose(from_);
        ::waitpid(pid_, nullptr, 0);
    }
    MpiProcess(const MpiProcess&) = delete;
    MpiProcess& operator=(const MpiProcess&) = delete;

    void write(const std::string& text) {
        std::fputs(text.c_str(), to_);
        std::fflush(to_);
    }
    void end_input() {
        if (to_ != nullptr) std::fclose(std::exchange(to_, nullptr));
    }
    std::FILE* output() { return from_; }

private:
    pid_t pid_ = -1;
    std::FILE* to_ = nullptr;
    std::FILE* from_ = nullptr;
};

}  // namespace meniscus::test
