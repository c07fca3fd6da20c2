#include "rpc/calls/status.hpp"

#include <gtest/gtest.h>

#include <system_error>

#include "meniscus/error.hpp"
#include "sessions/handover/start_thread.hpp"

namespace meniscus::server {
namespace {

TEST(Status, OfADeviceThatFailedIsInternalWithTheReason) {
    const DeviceError error("cudaStreamSynchronize", "unspecified launch failure", 1);
    const grpc::Status status = to_status(std::make_exception_ptr(error));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INTERNAL);
    EXPECT_EQ(status.error_message(), error.what());
}

TEST(Status, OfAFrameTooLargeForTheDeviceIsResourceExhausted) {
    const grpc::Status status = to_status(std::make_exception_ptr(LimitExceeded("too large")));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

/// The error of std::thread where the system starts no more.
std::system_error no_thread() {
    return {std::make_error_code(std::errc::resource_unavailable_try_again)};
}

TEST(Status, OfAThreadThatCannotStartIsResourceExhausted) {
    const grpc::Status status = to_status(std::make_exception_ptr(no_thread()));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_NE(status.error_message().find("ulimit -u"), std::string::npos) << status.error_message();
}

TEST(StartThread, NamesTheThreadThatCannotStart) {
    struct Work {
        Work() = default;
        Work(Work&& /*other*/) noexcept(false) { throw no_thread(); }
        void operator()() const {}
    };
    start_thread("that rests", [] {}).join();
    try {
        start_thread("that knits", Work());
        ADD_FAILURE();
    } catch (const LimitExceeded& error) {
        EXPECT_NE(std::string(error.what()).find("the thread that knits"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace meniscus::server
