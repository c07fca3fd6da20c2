#include "rpc/caller.hpp"

#include <string_view>
#include <vector>

namespace meniscus::server {

Caller admit(const Authorizer& authorizer, const grpc::ServerContextBase& context, Action action) {
    std::vector<std::string_view> values;
    const auto [first, last] = context.client_metadata().equal_range("authorization");
    for (auto entry = first; entry != last; ++entry) values.emplace_back(entry->second.data(), entry->second.size());
    return authorizer.admit(values, action);
}

}  // namespace meniscus::server
