// The code of an error, beside its text.
#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <set>
#include <string>

#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using client::code_of;
using client::ErrorCode;

/// The code of the exception that the function throws.
template <class Function>
ErrorCode code_from(Function function) {
    try {
        function();
    } catch (const std::exception& error) {
        return code_of(error);
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorCode::unknown;
}

TEST(ErrorCode, IsThatOfEveryExceptionThatTheLibrariesThrow) {
    EXPECT_EQ(code_of(InvalidInput("")), ErrorCode::invalid_input);
    EXPECT_EQ(code_of(LimitExceeded("")), ErrorCode::limit_exceeded);
    EXPECT_EQ(code_of(DeviceError("", "", 0)), ErrorCode::device);
    EXPECT_EQ(code_of(Stopped()), ErrorCode::canceled);
    EXPECT_EQ(code_of(std::bad_alloc()), ErrorCode::out_of_memory);
    EXPECT_EQ(code_of(client::ServerError("")), ErrorCode::data_loss);
    EXPECT_EQ(code_of(client::ServerError("", ErrorCode::aborted)), ErrorCode::aborted);
    EXPECT_EQ(code_of(std::runtime_error("")), ErrorCode::unknown);
}

TEST(ErrorCode, HasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (int code = 0; code <= static_cast<int>(ErrorCode::unknown); ++code)
        EXPECT_TRUE(names.insert(name_of(static_cast<ErrorCode>(code))).second) << code;
    EXPECT_FALSE(names.contains(""));
}

TEST(ErrorCode, TellsWhyTheServerRefused) {
    auto running = std::make_unique<RunningServer>();
    client::Client client(running->server.address());
    const std::string id = running->session();
    const std::string absent = client::new_session_id();
    Settings other = settings();
    other.particle_radius *= 2.0;
    EXPECT_EQ(code_from([] { client::Client(""); }), ErrorCode::invalid_input);
    EXPECT_EQ(code_from([&] { client.session(absent); }), ErrorCode::not_found);
    EXPECT_EQ(code_from([&] { client.watch(absent).next(); }), ErrorCode::not_found);
    EXPECT_EQ(code_from([&] { client.create_session(id, other); }), ErrorCode::already_exists);
    EXPECT_EQ(code_from([&] { client.create_session("dam", settings()); }), ErrorCode::invalid_input);
    EXPECT_EQ(code_from([&] { client.recordings(); }), ErrorCode::unimplemented);
    auto one = client.stream(id);
    one.push(wave(3, 0.0).view(), 0, 0.0);
    one.next();
    EXPECT_EQ(code_from([&] { client.stream(id).next(); }), ErrorCode::failed_precondition);
    EXPECT_EQ(code_from([&] { client::Client("127.0.0.1:1"); }), ErrorCode::unavailable);
    EXPECT_EQ(code_from([&] { client.session(std::string("a\0b", 3)); }), ErrorCode::invalid_input);
    EXPECT_EQ(code_from([&] { client.watch(id + "\n").next(); }), ErrorCode::invalid_input);
    running.reset();
    EXPECT_EQ(code_from([&] { client.session(id); }), ErrorCode::unavailable);
}

}  // namespace
}  // namespace meniscus::server::test
