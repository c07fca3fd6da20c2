// Watchers' options, and watchers too many.
#include <limits>
#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

/// Watches until the session ends.
template <class Response>
grpc::Status watch(RunningServer& running, const std::string& session, grpc::ClientReader<Response>& call) {
    call.WaitForInitialMetadata();
    // A watcher that was accepted is one until its session ends; for one that was refused there is nothing to end.
    try {
        running.client.delete_session(session);
    } catch (const client::ServerError&) {
    }
    Response ignored;
    while (call.Read(&ignored)) {
    }
    return call.Finish();
}

/// The session is given with the metadata.
grpc::Status watch(RunningServer& running, const std::string& session, const v1::WatchRequest& request) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, session);
    return watch(running, session, *connection.surfaces->Watch(&context, request));
}

grpc::Status watch(RunningServer& running, const std::string& session, const v1::WatchParticlesRequest& request) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, session);
    return watch(running, session, *connection.surfaces->WatchParticles(&context, request));
}

grpc::Status watch(RunningServer& running, const std::string& session, const v1::SnapshotRequest& request) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, session);
    return watch(running, session, *connection.surfaces->Snapshot(&context, request));
}

/// Watches a new session, with this change of the request.
template <class Request>
std::function<grpc::Status(RunningServer&)> watch_with(std::function<void(Request&)> change) {
    return [change = std::move(change)](RunningServer& running) {
        const std::string session = running.session();
        Request request;
        request.set_session_id(session);
        change(request);
        return watch(running, session, request);
    };
}

std::function<grpc::Status(RunningServer&)> watch_with(std::function<void(v1::WatchRequest&)> change) {
    return watch_with<v1::WatchRequest>(std::move(change));
}

std::function<grpc::Status(RunningServer&)> particles_with(std::function<void(v1::WatchParticlesRequest&)> change) {
    return watch_with<v1::WatchParticlesRequest>(std::move(change));
}

std::function<grpc::Status(RunningServer&)> snapshot_with(std::function<void(v1::SnapshotRequest&)> change) {
    return watch_with<v1::SnapshotRequest>(std::move(change));
}

/// Watches a session that has this many watchers already.
template <class Request>
std::function<grpc::Status(RunningServer&)> beside(std::size_t watchers) {
    return [=](RunningServer& running) {
        const std::string session = running.session();
        std::vector<client::Watcher> others;
        for (std::size_t i = 0; i < watchers; ++i) others.push_back(running.client.watch(session));
        Request request;
        request.set_session_id(session);
        return watch(running, session, request);
    };
}

}  // namespace

std::vector<BadInputCase> watch_cases() {
    const auto normal_bits = [](std::uint32_t bits) {
        return watch_with([=](v1::WatchRequest& request) { request.set_normal_bits(bits); });
    };
    const auto attributes = [](int count, std::uint32_t bits) {
        return watch_with([=](v1::WatchRequest& request) {
            for (int i = 0; i < count; ++i) {
                v1::AttributeWish& attribute = *request.add_attributes();
                attribute.set_name("a" + std::to_string(i));
                attribute.set_bits(bits);
            }
        });
    };
    const auto position_bits = [](std::uint32_t bits) {
        return watch_with([=](v1::WatchRequest& request) { request.set_position_bits(bits); });
    };
    const auto max_level = [](std::uint32_t level) {
        return watch_with([=](v1::WatchRequest& request) { request.set_max_level(level); });
    };
    const auto region = [](double low, double high) {
        return watch_with([=](v1::WatchRequest& request) {
            request.mutable_region()->mutable_min()->set_y(low);
            request.mutable_region()->mutable_max()->set_x(1.0);
            request.mutable_region()->mutable_max()->set_y(high);
            request.mutable_region()->mutable_max()->set_z(1.0);
        });
    };
    return {
        {"TheCoarsestPositions", ok, "", position_bits(2)},
        {"PositionsTooCoarse", invalid, "position_bits is 1; it must be 2 to 6, the session's, or not set",
         position_bits(1)},
        {"TheFinestPositions", ok, "", position_bits(6)},
        {"PositionsFinerThanTheMesh", invalid, "position_bits is 7; it must be 2 to 6", position_bits(7)},
        {"TheCoarsestLevelOfGrid", ok, "", max_level(1)},
        {"TheLevelZeroOfGrid", invalid, "max_level is 0; it must be 1 to 3, or not set", max_level(0)},
        {"TheFinestLevelOfGrid", ok, "", max_level(3)},
        {"ALevelOfGridPastTheFinest", invalid, "max_level is 4; it must be 1 to 3, or not set", max_level(4)},
        {"AHugeRegion", ok, "", region(-1e300, 1e300)},
        {"AFlatRegion", invalid, "region runs from 1 to 1 on the y axis; it must be finite, its min less than its max",
         region(1.0, 1.0)},
        {"AnEndlessRegion", invalid, "region runs from 0 to inf on the y axis",
         region(0.0, std::numeric_limits<double>::infinity())},
        {"ARegionThatIsNoNumber", invalid, "region runs from nan to 1 on the y axis",
         region(std::numeric_limits<double>::quiet_NaN(), 1.0)},
        {"ARegionWithoutACorner", invalid, "region needs both its corners, min and max",
         watch_with([](v1::WatchRequest& request) { request.mutable_region()->mutable_min(); })},
        {"AViewpointThatIsNoNumber", invalid, "viewpoint is (0, 0, nan); it must be finite",
         watch_with([](v1::WatchRequest& request) {
             request.mutable_viewpoint()->set_z(std::numeric_limits<double>::quiet_NaN());
         })},
        {"OneBytePerSecond", ok, "", watch_with([](v1::WatchRequest& request) { request.set_bytes_per_second(1); })},
        {"MoreBytesPerSecondThanThereAre", ok, "", watch_with([](v1::WatchRequest& request) {
             request.set_bytes_per_second(std::numeric_limits<std::uint64_t>::max());
         })},
        {"AWatcherWithSixteenNormalBits", ok, "", normal_bits(16)},
        {"AWatcherWithSeventeenNormalBits", invalid, "normal_bits is 17; it must be 0 (no normals) or 2 to 16",
         normal_bits(17)},
        {"AWatcherWithOneNormalBit", invalid, "normal_bits is 1; it must be 0 (no normals) or 2 to 16", normal_bits(1)},
        {"AWatcherOfSixteenAttributesThatThereAreNot", ok, "", attributes(16, 8)},
        {"AWatcherOfSeventeenAttributes", invalid, "17 wished attributes; at most 16 are possible", attributes(17, 8)},
        {"AWatcherOfExactAttributes", ok, "", attributes(1, 0)},
        {"AWatcherOfSixteenAttributeBits", ok, "", attributes(1, 16)},
        {"AWatcherOfSeventeenAttributeBits", invalid,
         "wished attribute 'a0' has 17 bits, must have 1 to 16, or 0 for exact values", attributes(1, 17)},
        {"AWatcherOfAnAttributeTwice", invalid, "wished attribute 'a' comes twice; each comes once",
         watch_with([](v1::WatchRequest& request) {
             request.add_attributes()->set_name("a");
             request.add_attributes()->set_name("a");
         })},
        {"AWatcherOfAllAttributes", ok, "", watch_with([](v1::WatchRequest& request) { request.add_attributes(); })},
        {"AWatcherOfAllAttributesTwice", invalid, "wished attribute '' comes twice; each comes once",
         watch_with([](v1::WatchRequest& request) {
             request.add_attributes();
             request.add_attributes();
         })},
        {"AWatcherOfAnAttributeWhoseNameNoneHas", invalid,
         "the name of wished attribute 0 must be 1 to 64 of a-z, 0-9 and _",
         watch_with([](v1::WatchRequest& request) { request.add_attributes()->set_name("A\n"); })},
        {"ASnapshotOfSeventeenAttributeBits", invalid,
         "wished attribute 'a' has 17 bits, must have 1 to 16, or 0 for exact values",
         snapshot_with([](v1::SnapshotRequest& request) {
             request.add_attributes()->set_name("a");
             request.mutable_attributes(0)->set_bits(17);
         })},
        {"AWatcherOfTheCodecDraco", ok, "",
         watch_with([](v1::WatchRequest& request) { request.add_codecs(v1::CODEC_DRACO); })},
        {"AWatcherOfACodecOfTheFuture", invalid,
         "codecs has the value 7, which this version does not offer; it offers 3 (entropy), 2 (packed), 1 (draco)",
         watch_with([](v1::WatchRequest& request) { request.add_codecs(static_cast<v1::Codec>(7)); })},
        {"AWatcherWithoutSessionId", invalid, "the message's session id is \"\"; it must be a UUID",
         watch_with([](v1::WatchRequest& request) { request.clear_session_id(); })},
        {"AWatcherOfAnotherSessionThanItsMetadataSays", invalid, "but the message's session id is " + no_session,
         watch_with([](v1::WatchRequest& request) { request.set_session_id(no_session); })},
        {"AWatcherOfNoSession", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         [](RunningServer& running) {
             v1::WatchRequest request;
             request.set_session_id(no_session);
             return watch(running, no_session, request);
         }},
        {"AWatchThatIsNoMessage", invalid, "is not a WatchRequest", watch_with([](v1::WatchRequest& request) {
             request = with_raw_field<v1::WatchRequest>(v1::WatchRequest::kRegionFieldNumber, "\x0a\x7f");
         })},
        {"AsManyWatchersAsTheLimit", ok, "", beside<v1::WatchRequest>(1)},
        {"AWatcherPastTheLimit", grpc::StatusCode::RESOURCE_EXHAUSTED,
         "has 2 watchers; the server takes at most 2 per session", beside<v1::WatchRequest>(2)},
        {"AsManyWatchersOfParticlesAsTheLimit", ok, "", beside<v1::WatchParticlesRequest>(1)},
        {"AWatcherOfParticlesPastTheLimit", grpc::StatusCode::RESOURCE_EXHAUSTED,
         "has 2 watchers; the server takes at most 2 per session", beside<v1::WatchParticlesRequest>(2)},
        {"ASnapshotOfASessionFullOfWatchers", ok, "", beside<v1::SnapshotRequest>(2)},
        {"ASnapshotOfTheLevelZeroOfGrid", invalid, "max_level is 0; it must be 1 to 3, or not set",
         snapshot_with([](v1::SnapshotRequest& request) { request.set_max_level(0); })},
        {"ASnapshotOfPositionsFinerThanTheMesh", invalid, "position_bits is 7; it must be 2 to 6",
         snapshot_with([](v1::SnapshotRequest& request) { request.set_position_bits(7); })},
        {"ASnapshotWithSeventeenNormalBits", invalid, "normal_bits is 17; it must be 0 (no normals) or 2 to 16",
         snapshot_with([](v1::SnapshotRequest& request) { request.set_normal_bits(17); })},
        {"ASnapshotOfACodecOfTheFuture", invalid, "codecs has the value 7, which this version does not offer",
         snapshot_with([](v1::SnapshotRequest& request) { request.add_codecs(static_cast<v1::Codec>(7)); })},
        {"ASnapshotOfAnotherSessionThanTheMetadataSays", invalid, "but the message's session id is " + no_session,
         snapshot_with([](v1::SnapshotRequest& request) { request.set_session_id(no_session); })},
        {"ASnapshotOfNoSession", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         [](RunningServer& running) {
             v1::SnapshotRequest request;
             request.set_session_id(no_session);
             return watch(running, no_session, request);
         }},
        {"ARequestForASnapshotThatIsNoMessage", invalid, "is not a SnapshotRequest",
         snapshot_with([](v1::SnapshotRequest& request) {
             request = with_raw_field<v1::SnapshotRequest>(v1::SnapshotRequest::kSessionIdFieldNumber, "\xff\xfe");
         })},
        {"AsManyParticlesAsThereAreNumbers", ok, "", particles_with([](v1::WatchParticlesRequest& request) {
             request.set_max_particles(std::numeric_limits<std::uint64_t>::max());
         })},
        {"ParticlesWithoutSessionId", invalid, "the message's session id is \"\"; it must be a UUID",
         particles_with([](v1::WatchParticlesRequest& request) { request.clear_session_id(); })},
        {"ParticlesOfAnotherSessionThanTheMetadataSays", invalid, "but the message's session id is " + no_session,
         particles_with([](v1::WatchParticlesRequest& request) { request.set_session_id(no_session); })},
        {"ParticlesOfNoSession", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         [](RunningServer& running) {
             v1::WatchParticlesRequest request;
             request.set_session_id(no_session);
             return watch(running, no_session, request);
         }},
        {"AWatchOfParticlesThatIsNoMessage", invalid, "is not a WatchParticlesRequest",
         particles_with([](v1::WatchParticlesRequest& request) {
             request = with_raw_field<v1::WatchParticlesRequest>(v1::WatchParticlesRequest::kSessionIdFieldNumber,
                                                                 "\xff\xfe");
         })},
    };
}

}  // namespace meniscus::server::test
