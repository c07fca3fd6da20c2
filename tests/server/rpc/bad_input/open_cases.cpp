// Streams that are refused as they are opened: ids, options, sessions that are not there or not free.
#include <limits>
#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

grpc::Status finish(RawStream& stream) {
    stream.call->WritesDone();
    return stream.finish();
}

/// Opens a stream of a new session, with this change to its open.
std::function<grpc::Status(RunningServer&)> open_with(std::function<void(v1::StreamOpen&)> change) {
    return [change = std::move(change)](RunningServer& running) {
        const CaseSession session(running);
        RawStream stream(running.server.address(), session.id, false);
        v1::StreamRequest request;
        request.mutable_open()->set_session_id(session.id);
        change(*request.mutable_open());
        stream.call->Write(request);
        return finish(stream);
    };
}

/// This id as metadata and in the message.
std::function<grpc::Status(RunningServer&)> session_id(std::string id) {
    return [id = std::move(id)](RunningServer& running) {
        RawStream stream(running.server.address(), id);
        return finish(stream);
    };
}

grpc::Status metadata_twice(RunningServer& running) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, no_session);
    client::add_session_id(context, no_session);
    const auto call = connection.surfaces->Stream(&context);
    call->WritesDone();
    v1::StreamResponse ignored;
    while (call->Read(&ignored)) {
    }
    return call->Finish();
}

grpc::Status another_stream_uploads(RunningServer& running) {
    const CaseSession session(running);
    RawStream first(running.server.address(), session.id);
    first.send_begin(0, 0);
    first.send_end();
    v1::StreamResponse answer;
    first.call->Read(&answer);
    RawStream second(running.server.address(), session.id);
    grpc::Status status = finish(second);
    finish(first);
    return status;
}

grpc::Status session_was_deleted(RunningServer& running) {
    const std::string id = running.session();
    running.client.delete_session(id);
    return session_id(id)(running);
}

}  // namespace

std::vector<BadInputCase> open_cases() {
    const auto normal_bits = [](std::uint32_t bits) {
        return open_with([=](v1::StreamOpen& open) { open.set_normal_bits(bits); });
    };
    const auto every_nth = [](std::uint32_t nth) {
        return open_with([=](v1::StreamOpen& open) {
            open.set_policy(v1::UPLOAD_POLICY_EVERY_NTH);
            open.set_nth(nth);
        });
    };
    const auto reconnect = [](double seconds) {
        return open_with([=](v1::StreamOpen& open) { open.set_reconnect_seconds(seconds); });
    };
    constexpr double endless = std::numeric_limits<double>::infinity();
    return {
        {"ATryToComeBackForALifetime", ok, "", reconnect(1e300)},
        {"ATryToComeBackForLessThanNoTime", invalid, "reconnect_seconds is -1; it must be finite and at least 0",
         reconnect(-1.0)},
        {"ATryToComeBackForEver", invalid, "reconnect_seconds is inf; it must be finite and at least 0",
         reconnect(endless)},
        {"ATryToComeBackForATimeThatIsNoNumber", invalid, "reconnect_seconds is nan; it must be finite",
         reconnect(std::numeric_limits<double>::quiet_NaN())},
        {"NoNormals", ok, "", normal_bits(0)},
        {"SeventeenAttributeBits", invalid,
         "wished attribute 'a' has 17 bits, must have 1 to 16, or 0 for exact values",
         open_with([](v1::StreamOpen& open) {
             open.add_attributes()->set_name("a");
             open.mutable_attributes(0)->set_bits(17);
         })},
        {"AllAttributesExactly", ok, "", open_with([](v1::StreamOpen& open) { open.add_attributes()->set_bits(0); })},
        {"OneNormalBit", invalid, "normal_bits is 1; it must be 0 (no normals) or 2 to 16", normal_bits(1)},
        {"TwoNormalBits", ok, "", normal_bits(2)},
        {"SixteenNormalBits", ok, "", normal_bits(16)},
        {"SeventeenNormalBits", invalid, "normal_bits is 17; it must be 0 (no normals) or 2 to 16", normal_bits(17)},
        {"MoreNormalBitsThanAnIntHolds", invalid, "normal_bits is 4294967295", normal_bits(0xFFFFFFFFU)},
        {"TheCodecDraco", ok, "", open_with([](v1::StreamOpen& open) { open.add_codecs(v1::CODEC_DRACO); })},
        {"ACodecOfTheFuture", invalid,
         "codecs has the value 7, which this version does not offer; it offers 3 (entropy), 2 (packed), 1 (draco)",
         open_with([](v1::StreamOpen& open) {
             open.add_codecs(v1::CODEC_DRACO);
             open.add_codecs(static_cast<v1::Codec>(7));
         })},
        {"ACodecWithoutANumber", invalid, "codecs has the value 0, which this version does not offer",
         open_with([](v1::StreamOpen& open) { open.add_codecs(v1::CODEC_UNSPECIFIED); })},
        {"APolicyOfTheFuture", invalid, "policy has the value 4, which this version does not know",
         open_with([](v1::StreamOpen& open) { open.set_policy(static_cast<v1::UploadPolicy>(4)); })},
        {"EveryFrameOfOne", ok, "", every_nth(1)},
        {"EveryFrameOfNone", invalid, "nth is 0; with UPLOAD_POLICY_EVERY_NTH it must be at least 1", every_nth(0)},
        {"NoSessionIdInTheMetadata", invalid, "the call has no metadata x-session-id",
         [](RunningServer& running) {
             RawStream stream(running.server.address());
             return finish(stream);
         }},
        {"TwoSessionIdsInTheMetadata", invalid, "the call has metadata x-session-id more than once", metadata_twice},
        {"AnEmptySessionId", invalid, "x-session-id is \"\"; it must be a UUID", session_id("")},
        {"ASessionIdInUpperCase", invalid,
         "x-session-id is \"ABCDEF00-0000-4000-8000-000000000000\"; it must be a UUID",
         session_id("ABCDEF00-0000-4000-8000-000000000000")},
        {"ASessionIdThatIsAPath", invalid, "x-session-id is \"../../../../../../../etc/passwd\"; it must be a UUID",
         session_id("../../../../../../../etc/passwd")},
        {"ASessionIdThatIsTooLong", invalid, "it must be a UUID of 8-4-4-4-12", session_id(no_session + "0")},
        {"ASessionIdOfManyBytes", invalid, "it must be a UUID of 8-4-4-4-12", session_id(std::string(4000, '0'))},
        {"NoSessionIdInTheMessage", invalid, "the message's session id is \"\"; it must be a UUID",
         open_with([](v1::StreamOpen& open) { open.clear_session_id(); })},
        {"AnotherSessionIdInTheMessage", invalid, "but the message's session id is " + no_session,
         open_with([](v1::StreamOpen& open) { open.set_session_id(no_session); })},
        {"ASessionThatWasNeverCreated", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         session_id(no_session)},
        {"ASessionThatWasDeleted", grpc::StatusCode::NOT_FOUND, "no session ", session_was_deleted},
        {"ASessionThatAnotherStreamUploadsTo", grpc::StatusCode::FAILED_PRECONDITION, "uploads to session ",
         another_stream_uploads},
    };
}

}  // namespace meniscus::server::test
