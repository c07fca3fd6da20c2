#include "rpc/services/standard_services.hpp"

#include <grpcpp/server_builder.h>

#include <grpc/grpc.h>
#include <grpcpp/ext/channelz_service_plugin.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/resource_quota.h>

#include <memory>
#include <vector>

namespace meniscus::server {

namespace {

/// Reflection and channelz hold a thread for each call. Calls of them beyond that are refused.
constexpr int thread_limit = 8;

/// Takes away what was not chosen.
class Choice final : public grpc::ServerBuilderOption {
public:
    explicit Choice(const StandardServices& services) : services_(services) {}

    void UpdateArguments(grpc::ChannelArguments* /*arguments*/) override {}

    void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
        std::erase_if(*plugins, [this](const std::unique_ptr<grpc::ServerBuilderPlugin>& plugin) {
            return (plugin->name() == "proto_server_reflection" && !services_.reflection) ||
                   (plugin->name() == "channelz_service" && !services_.channelz);
        });
    }

private:
    const StandardServices services_;
};

}  // namespace

void load_standard_services() {
    static const bool once = [] {
        // Never undone: the last object's end would shut gRPC down, and wait for its threads, which look up from some
        // of their waits after ten seconds.
        grpc_init();
        grpc::reflection::InitProtoReflectionServerBuilderPlugin();
        grpc::channelz::experimental::InitChannelzService();
        return true;
    }();
    static_cast<void>(once);
}

void add_standard_services(grpc::ServerBuilder& builder, const StandardServices& services) {
    builder.SetOption(std::make_unique<Choice>(services));
    if (services.reflection || services.channelz)
        builder.SetResourceQuota(grpc::ResourceQuota().SetMaxThreads(thread_limit));
}

}  // namespace meniscus::server
