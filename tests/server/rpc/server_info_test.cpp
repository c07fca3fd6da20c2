// GetServerInfo's limits are those of the rows.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include "rpc/handlers/server_info_handler.hpp"

namespace meniscus::server {
namespace {

TEST(ServerInfo, HasAValueForEachFieldOfTheLimits) {
    Limits limits;
    Limits::rows(limits, []<class Value>(std::string_view, Value& value, const Facts&, const auto&...) {
        if constexpr (!std::is_const_v<Value>) value = Value(1);
    });
    const v1::Limits message = get_server_info({}, 1, limits, false).limits();
    std::vector<const google::protobuf::FieldDescriptor*> set;
    message.GetReflection()->ListFields(message, &set);
    EXPECT_EQ(set.size(), static_cast<std::size_t>(v1::Limits::descriptor()->field_count()));
    EXPECT_EQ(message.upload_seconds(), 0.001);
    EXPECT_EQ(message.chunk_bytes(), chunk_bytes);
}

}  // namespace
}  // namespace meniscus::server
