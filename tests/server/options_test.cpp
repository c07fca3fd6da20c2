#include "options.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

namespace meniscus::server {
namespace {

ServerOptions parse(std::initializer_list<const char*> flags) {
    std::vector<const char*> argv{"meniscusd"};
    argv.insert(argv.end(), flags);
    CommandLine command_line;
    const auto exit = parse_command_line(static_cast<int>(argv.size()), argv.data(), command_line);
    EXPECT_FALSE(exit) << exit->text;
    return command_line.server;
}

TEST(Options, ListDevices) {
    EXPECT_EQ(parse({"--devices", "0,3,1"}).devices, (std::vector<int>{0, 3, 1}));
    EXPECT_EQ(parse({"--devices=2", "--threads", "1"}).devices, (std::vector<int>{2}));
}

TEST(Options, UseAllDevicesWithoutALimitUnlessTold) {
    const ServerOptions options = parse({});
    EXPECT_TRUE(options.devices.empty());
    EXPECT_EQ(options.limits.device_bytes_per_session, 0U);
}

}  // namespace
}  // namespace meniscus::server
