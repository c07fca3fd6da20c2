#include "process/available_memory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "test_folder.hpp"

namespace meniscus::server::test {
namespace {

class AvailableMemory : public testing::Test {
protected:
    void write(const std::string& file, const std::string& text) {
        const std::filesystem::path path = std::filesystem::path(folder_ / file);
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    std::uint64_t available() const { return available_memory(folder_ / ""); }

    const std::uint64_t machine = available_memory("/nowhere");

private:
    TestFolder folder_;
};

TEST_F(AvailableMemory, IsTheMachinesWithoutControlGroups) {
    EXPECT_GT(machine, 100U << 20);
    EXPECT_EQ(available(), machine);
}

TEST_F(AvailableMemory, IsWhatAContainerMayUse) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/memory.max", "104857600\n");
    EXPECT_EQ(available(), 100U << 20);
}

TEST_F(AvailableMemory, IsTheSmallestOfTheGroupsAroundTheProcess) {
    write("proc/self/cgroup", "0::/slice/service\n");
    write("sys/fs/cgroup/slice/memory.max", "50000000\n");
    write("sys/fs/cgroup/slice/service/memory.max", "max\n");
    EXPECT_EQ(available(), 50000000U);
    write("sys/fs/cgroup/slice/service/memory.max", "40000000\n");
    EXPECT_EQ(available(), 40000000U);
}

TEST_F(AvailableMemory, IsFoundWithTheOlderControlGroups) {
    write("proc/self/cgroup", "5:cpu,memory:/a\n4:pids:/b\n0::/\n");
    write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "30000000\n");
    write("sys/fs/cgroup/memory/b/memory.limit_in_bytes", "1\n");
    EXPECT_EQ(available(), 30000000U);
}

TEST_F(AvailableMemory, IsTheMachinesWhereNothingIsLimited) {
    write("proc/self/cgroup", "0::/a\nnonsense\n::\n4:memory:\n");
    write("sys/fs/cgroup/a/memory.max", "max\n");
    EXPECT_EQ(available(), machine);
    write("sys/fs/cgroup/a/memory.max", "9223372036854771712\n");
    EXPECT_EQ(available(), machine);
}

}  // namespace
}  // namespace meniscus::server::test
