// Sessions over the wire.
#include <gtest/gtest.h>

#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

grpc::Status create_raw(RunningServer& running, const std::string& metadata, const std::string& id,
                        v1::Settings settings) {
    const client::Connection connection(running.server.address());
    grpc::ClientContext context;
    if (!metadata.empty()) client::add_session_id(context, metadata);
    v1::CreateSessionRequest request;
    request.set_id(id);
    *request.mutable_settings() = std::move(settings);
    v1::CreateSessionResponse response;
    return connection.sessions->CreateSession(&context, request, &response);
}

TEST(Sessions, KeepEverySetting) {
    RunningServer running;
    Settings chosen = settings();
    chosen.iso = 0.5;
    chosen.field = Field::density;
    chosen.smoothing_length = 1.75;
    chosen.mode = Mode::uniform;
    chosen.criterion = CountCriterion{3};
    chosen.edge_points = Bisection{4};
    chosen.normals = false;
    chosen.domain = Box{.min = {-1.0, -2.0, -3.0}, .max = {4.0, 5.0, 6.0}};
    const std::string id = client::new_session_id();
    running.client.create_session(id, chosen);
    EXPECT_EQ(running.client.session(id).settings, chosen);

    Settings smooth = settings();
    smooth.field = Field::smooth;
    smooth.smoothness = 7;
    smooth.spray = Spray::discard;
    smooth.criterion = CurvatureCriterion{0.3};
    const std::string other = client::new_session_id();
    running.client.create_session(other, smooth);
    EXPECT_EQ(running.client.session(other).settings, smooth);
}

TEST(Sessions, AreCreatedOnceHoweverOftenWithEqualSettings) {
    RunningServer running;
    const std::string id = running.session();
    running.client.create_session(id, settings());
    // Defaults that are named are no other settings.
    running.client.create_session(id, in_force(settings()));
    EXPECT_EQ(running.client.sessions().size(), 1U);
    Settings other = settings();
    other.cell_size = 2.0;
    EXPECT_THROW(running.client.create_session(id, other), client::ServerError);
    EXPECT_EQ(running.client.session(id).settings, in_force(settings()));
}

TEST(Sessions, FillDefaultsIn) {
    RunningServer running;
    const std::string id = client::new_session_id();
    v1::Settings wire;
    wire.set_particle_radius(radius);
    ASSERT_TRUE(create_raw(running, id, id, wire).ok());
    Settings defaults;
    defaults.particle_radius = radius;
    defaults.criterion = CurvatureCriterion{0.15};  // a tolerance that is absent
    EXPECT_EQ(running.client.session(id).settings, in_force(defaults));
}

TEST(Sessions, AreRefusedPastTheLimit) {
    ServerOptions options = test_options();
    options.limits.sessions = 1;
    RunningServer running(options);
    const std::string id = running.session();
    EXPECT_THROW(running.session(), LimitExceeded);
    running.client.delete_session(id);
    EXPECT_NO_THROW(running.session());
}

TEST(Sessions, AreRefusedWithSettingsOutOfRange) {
    RunningServer running;
    EXPECT_THROW(running.client.create_session(client::new_session_id(), Settings{}), InvalidInput);
    v1::Settings unknown = conversion::to_wire(settings());
    unknown.set_field(static_cast<v1::Field>(77));
    const std::string id = client::new_session_id();
    const grpc::Status status = create_raw(running, id, id, unknown);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_NE(status.error_message().find("77"), std::string::npos);
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(Sessions, AreRefusedWithSettingsOfAnotherField) {
    RunningServer running;
    Settings smooth = settings();
    smooth.field = Field::smooth;
    smooth.smoothing_length = 2.0;
    try {
        running.client.create_session(client::new_session_id(), smooth);
        ADD_FAILURE() << "a smoothing length with the smooth field is taken";
    } catch (const InvalidInput& e) {
        for (const char* word : {"smoothing length is 2", "--smoothness", "--field color"})
            EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(Sessions, NeedAUuidInMessageAndMetadata) {
    RunningServer running;
    const v1::Settings wire = conversion::to_wire(settings());
    const std::string id = client::new_session_id();
    for (const auto& [metadata, message] :
         {std::pair{std::string(), id}, std::pair{id, client::new_session_id()},
          std::pair{std::string("water"), std::string("water")}, std::pair{id, std::string()}})
        EXPECT_EQ(create_raw(running, metadata, message, wire).error_code(), grpc::StatusCode::INVALID_ARGUMENT)
            << metadata << " / " << message;
}

TEST(Sessions, AreNotFoundBeforeCreationAndAfterDeletion) {
    RunningServer running;
    EXPECT_THROW(running.client.session(client::new_session_id()), client::ServerError);
    const std::string id = running.session();
    running.client.delete_session(id);
    EXPECT_THROW(running.client.session(id), client::ServerError);
    EXPECT_THROW(running.client.delete_session(id), client::ServerError);
    EXPECT_TRUE(running.client.sessions().empty());
}

TEST(Sessions, HaveIdsThatDiffer) {
    EXPECT_NE(client::new_session_id(), client::new_session_id());
}

TEST(ServerInfo, NamesBackendCodecsAndLimits) {
    ServerOptions options = test_options();
    options.limits = {.sessions = 3,
                      .watchers_per_session = 4,
                      .particles_per_frame = 5,
                      .bytes_per_session = 6,
                      .device_bytes_per_session = 7};
    RunningServer running(options);
    const client::ServerInfo info = running.client.server_info();
    EXPECT_EQ(info.version, version());
    EXPECT_EQ(info.backend, running.server.backend().name);
    EXPECT_FALSE(info.device.empty());
    EXPECT_FALSE(info.backend_reason.empty());
    EXPECT_EQ(info.threads, 2U);
    EXPECT_EQ(info.codecs, (std::vector<std::uint32_t>{3, 2, 1}));
    EXPECT_EQ(info.max_sessions, 3U);
    EXPECT_EQ(info.max_watchers_per_session, 4U);
    EXPECT_EQ(info.max_particles_per_frame, 5U);
    EXPECT_EQ(info.max_bytes_per_session, 6U);
    EXPECT_EQ(info.max_device_bytes_per_session, 7U);
}

}  // namespace
}  // namespace meniscus::server::test
