#include "rpc/status.hpp"

#include <gtest/gtest.h>

#include "meniscus/error.hpp"

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

}  // namespace
}  // namespace meniscus::server
