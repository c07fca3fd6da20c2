// Recordings that cannot be read.
#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

/// Reads with this metadata.
std::function<grpc::Status(RunningServer&)> read(std::string metadata,
                                                 std::function<void(v1::ReadRecordingRequest&)> change) {
    return [metadata = std::move(metadata), change = std::move(change)](RunningServer& running) {
        const client::Connection connection = connect(running);
        grpc::ClientContext context;
        client::add_session_id(context, metadata);
        v1::ReadRecordingRequest request;
        request.set_session_id(no_session);
        request.set_number(1);
        change(request);
        const auto call = connection.recordings->ReadRecording(&context, request);
        v1::WatchResponse ignored;
        while (call->Read(&ignored)) {
        }
        return call->Finish();
    };
}

/// Deletes with this metadata.
std::function<grpc::Status(RunningServer&)> deletion(const std::string& metadata, const std::string& session,
                                                     std::uint32_t number) {
    return [=](RunningServer& running) {
        const client::Connection connection = connect(running);
        grpc::ClientContext context;
        client::add_session_id(context, metadata);
        v1::DeleteRecordingRequest request;
        request.set_session_id(session);
        request.set_number(number);
        v1::DeleteRecordingResponse response;
        return connection.recordings->DeleteRecording(&context, request, &response);
    };
}

}  // namespace

std::vector<BadInputCase> recording_cases() {
    const auto nothing = [](v1::ReadRecordingRequest&) {};
    const auto session = [](std::string id) {
        return [id = std::move(id)](v1::ReadRecordingRequest& request) { request.set_session_id(id); };
    };
    return {
        {"ARecordingOfNoSession", grpc::StatusCode::NOT_FOUND, "no recording 1 of session " + no_session,
         read(no_session, nothing)},
        {"ARecordingThatIsAPath", invalid, "x-session-id is \"../../etc\"; it must be a UUID",
         read("../../etc", session("../../etc"))},
        {"ARecordingThatIsAPathInTheMessage", invalid, "the message's session id is \"..\"; it must be a UUID",
         read(no_session, session(".."))},
        {"ARecordingOfAnotherSessionThanItsMetadataSays", invalid, "but the message's session id is",
         read(no_session, session("00000000-0000-4000-8000-000000000001"))},
        {"ARecordingInACodecOfTheFuture", invalid,
         "codecs has the value 7, which this version does not offer; it offers 3 (entropy), 2 (packed), 1 (draco)",
         read(no_session, [](v1::ReadRecordingRequest& request) { request.add_codecs(static_cast<v1::Codec>(7)); })},
        {"ARecordingThatIsNoMessage", invalid, "is not a ReadRecordingRequest",
         read(no_session,
              [](v1::ReadRecordingRequest& request) {
                  request = with_raw_field<v1::ReadRecordingRequest>(v1::ReadRecordingRequest::kSessionIdFieldNumber,
                                                                     "\xff\xfe");
              })},
        {"ADeletionOfNoRecording", grpc::StatusCode::NOT_FOUND, "no recording 3 of session " + no_session,
         deletion(no_session, no_session, 3)},
        {"ADeletionOfNoNumber", grpc::StatusCode::NOT_FOUND, "no recording 0 of session " + no_session,
         deletion(no_session, no_session, 0)},
        {"ADeletionOfAPath", invalid, "x-session-id is \"../../etc\"; it must be a UUID",
         deletion("../../etc", "../../etc", 1)},
        {"ADeletionOfAPathInTheMessage", invalid, "the message's session id is \"..\"; it must be a UUID",
         deletion(no_session, "..", 1)},
        {"ADeletionOfAnotherSessionThanItsMetadataSays", invalid, "but the message's session id is",
         deletion(no_session, "00000000-0000-4000-8000-000000000001", 1)},
    };
}

}  // namespace meniscus::server::test
