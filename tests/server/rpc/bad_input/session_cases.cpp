// Sessions that cannot be created, found or deleted.
#include <grpcpp/impl/codegen/client_unary_call.h>
#include <grpcpp/support/byte_buffer.h>

#include <limits>
#include <utility>

#include "conversion/settings_conversion.hpp"
#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

grpc::Status create(RunningServer& running, const std::string& metadata, const v1::CreateSessionRequest& request) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, metadata);
    v1::CreateSessionResponse response;
    grpc::Status status = connection.sessions->CreateSession(&context, request, &response);
    if (status.ok()) running.client.delete_session(request.id());
    return status;
}

/// Creates a session whose settings are the tests', with this change.
std::function<grpc::Status(RunningServer&)> settings_with(std::function<void(v1::Settings&)> change) {
    return [change = std::move(change)](RunningServer& running) {
        v1::CreateSessionRequest request;
        request.set_id(client::new_session_id());
        *request.mutable_settings() = conversion::to_wire(settings());
        change(*request.mutable_settings());
        return create(running, request.id(), request);
    };
}

/// Creates a session of the tests' settings, with this change of its description.
std::function<grpc::Status(RunningServer&)> description_with(std::function<void(v1::SessionDescription&)> change) {
    return [change = std::move(change)](RunningServer& running) {
        v1::CreateSessionRequest request;
        request.set_id(client::new_session_id());
        *request.mutable_settings() = conversion::to_wire(settings());
        change(*request.mutable_description());
        return create(running, request.id(), request);
    };
}

/// Creates a session with this field and nothing of another.
std::function<grpc::Status(RunningServer&)> field_with(v1::Field field, std::function<void(v1::Settings&)> change) {
    return settings_with([=, change = std::move(change)](v1::Settings& s) {
        s.set_field(field);
        s.clear_smoothing_length();
        s.clear_smoothness();
        s.clear_spray();
        change(s);
    });
}

std::function<grpc::Status(RunningServer&)> id(std::string in_message) {
    return [in_message = std::move(in_message)](RunningServer& running) {
        v1::CreateSessionRequest request;
        request.set_id(in_message);
        *request.mutable_settings() = conversion::to_wire(settings());
        return create(running, client::new_session_id(), request);
    };
}

/// A unary call with these bytes for its request.
std::function<grpc::Status(RunningServer&)> bytes_to(const char* method, const std::string& bytes) {
    return [=](RunningServer& running) {
        const client::Connection connection = connect(running);
        grpc::ClientContext context;
        client::add_session_id(context, no_session);
        const grpc::Slice slice(bytes);
        const grpc::ByteBuffer request(&slice, 1);
        grpc::ByteBuffer response;
        return grpc::internal::BlockingUnaryCall(
            connection.channel.get(),
            grpc::internal::RpcMethod(method, grpc::internal::RpcMethod::NORMAL_RPC, connection.channel), &context,
            request, &response);
    };
}

/// While this many sessions are open: those made here, and the one of the test that runs all cases.
std::function<grpc::Status(RunningServer&)> beside(std::size_t sessions) {
    return [=](RunningServer& running) {
        std::vector<std::unique_ptr<CaseSession>> others;
        while (running.client.sessions().size() < sessions) others.push_back(std::make_unique<CaseSession>(running));
        return settings_with([](v1::Settings&) {})(running);
    };
}

template <class Request, class Response>
grpc::Status about_no_session(RunningServer& running,
                              grpc::Status (v1::SessionService::Stub::*method)(grpc::ClientContext*, const Request&,
                                                                               Response*)) {
    const client::Connection connection = connect(running);
    grpc::ClientContext context;
    client::add_session_id(context, no_session);
    Request request;
    request.set_id(no_session);
    Response response;
    return (*connection.sessions.*method)(&context, request, &response);
}

grpc::Status exists_with_other_settings(RunningServer& running) {
    const CaseSession session(running);
    v1::CreateSessionRequest request;
    request.set_id(session.id);
    request.mutable_settings()->set_particle_radius(1.0);
    return create(running, session.id, request);
}

}  // namespace

std::vector<BadInputCase> session_cases() {
    const auto attributes = [](int count) {
        return settings_with([=](v1::Settings& s) {
            for (int i = 0; i < count; ++i) s.add_attributes("a" + std::to_string(i));
        });
    };
    const auto radius_of = [](double value) {
        return settings_with([=](v1::Settings& s) { s.set_particle_radius(value); });
    };
    const auto cell_size = [](double value) {
        return field_with(v1::FIELD_COLOR, [=](v1::Settings& s) { s.set_cell_size(value); });
    };
    const auto iso = [](double value) { return settings_with([=](v1::Settings& s) { s.set_iso(value); }); };
    const auto steps = [](std::uint32_t value) {
        return settings_with([=](v1::Settings& s) { s.mutable_bisect()->set_steps(value); });
    };
    const auto smoothness = [](std::uint32_t value) {
        return field_with(v1::FIELD_SMOOTH, [=](v1::Settings& s) { s.set_smoothness(value); });
    };
    const auto domain = [](double low, double high) {
        return settings_with([=](v1::Settings& s) {
            s.mutable_domain()->mutable_min()->set_x(low);
            s.mutable_domain()->mutable_max()->set_x(high);
            s.mutable_domain()->mutable_max()->set_y(1.0);
            s.mutable_domain()->mutable_max()->set_z(1.0);
        });
    };
    const auto name = [](const std::string& text) {
        return description_with([=](v1::SessionDescription& d) { d.set_name(text); });
    };
    const auto unit = [](const std::string& text) {
        return description_with([=](v1::SessionDescription& d) { d.set_length_unit(text); });
    };
    return {
        {"TheLongestNameOfASession", ok, "", name(std::string(64, 'a'))},
        {"ANameOfASessionThatIsTooLong", invalid, "it must be 1 to 64 characters of UTF-8", name(std::string(65, 'a'))},
        {"ANameOfASessionOfAMegabyte", grpc::StatusCode::RESOURCE_EXHAUSTED, "bytes; at most 65536 are taken",
         name(std::string(1 << 20, 'a'))},
        {"ANameOfASessionThatMovesTheCursor", invalid, "description.name is \"a\\u{001b}[2J\"; it must be",
         name("a\x1b[2J")},
        {"ANameOfASessionThatEndsItsLine", invalid, "and has \\u{000a}", name("a\nb")},
        {"ANameOfASessionThatRunsBackward", invalid, "and has \\u{202e}", name("a\u202egnp.exe")},
        {"ANameOfASessionThatCannotBeSeen", invalid, "it must have a character that can be seen", name(" ")},
        {"ANameOfASessionThatIsNotUtf8", invalid, "is not a CreateSessionRequest", name("a\xff")},
        {"TheLongestUnit", ok, "", unit(std::string(16, 'm'))},
        {"AUnitThatIsTooLong", invalid, "description.length_unit is \"mmmmmmmmmmmmmmmmm\"; it must be 1 to 16",
         unit(std::string(17, 'm'))},
        {"AnUnknownUpAxis", invalid, "description.up_axis has the value 4, which this version does not know",
         description_with([](v1::SessionDescription& d) { d.set_up_axis(static_cast<v1::UpAxis>(4)); })},
        {"NoSettings", invalid, "particle radius is 0, must be finite and greater than 0",
         settings_with([](v1::Settings& s) { s.Clear(); })},
        {"ARadiusBelowZero", invalid, "particle radius is -1, must be finite and greater than 0", radius_of(-1.0)},
        {"ARadiusThatIsNoNumber", invalid, "particle radius is nan, must be finite and greater than 0",
         radius_of(no_number)},
        {"ARadiusWhoseCellIsBelowAllNumbers", invalid,
         "cell size in world units is 0, must be finite and greater than 0",
         field_with(v1::FIELD_COLOR,
                    [](v1::Settings& s) {
                        s.set_particle_radius(1e-300);
                        s.set_cell_size(1e-300);
                        s.set_smoothing_length(1e-300);
                    })},
        {"ASmoothingLengthOfZero", invalid, "smoothing length is 0, must be finite and greater than 0",
         field_with(v1::FIELD_COLOR, [](v1::Settings& s) { s.set_smoothing_length(0.0); })},
        {"ASmoothingLengthOfTheSmoothField", invalid,
         "the smoothing length is 2, but the field is smooth, which has none: leave it out and use --smoothness, or "
         "take "
         "--field color",
         field_with(v1::FIELD_SMOOTH, [](v1::Settings& s) { s.set_smoothing_length(2.0); })},
        {"ASmoothnessOfTheColorField", invalid,
         "the smoothness is 6, but the field is color, which has none: leave it out and use --smoothing-length, or "
         "take "
         "--field smooth",
         field_with(v1::FIELD_COLOR, [](v1::Settings& s) { s.set_smoothness(6); })},
        {"TheLeastSmoothness", ok, "", smoothness(5)},
        {"TheGreatestSmoothness", ok, "", smoothness(7)},
        {"ASmoothnessOfFour", invalid, "the smoothness is 4, must be 5 to 7", smoothness(4)},
        {"ASmoothnessOfEight", invalid, "the smoothness is 8, must be 5 to 7", smoothness(8)},
        {"SprayOfTheColorField", invalid,
         "spray is points, but the field is color, which does not tell spray from water: take --spray keep or --field "
         "smooth",
         field_with(v1::FIELD_COLOR, [](v1::Settings& s) { s.set_spray(v1::SPRAY_POINTS); })},
        {"AnUnknownSpray", invalid, "settings.spray has the value 7, which this version does not know",
         settings_with([](v1::Settings& s) { s.set_spray(static_cast<v1::Spray>(7)); })},
        {"ACellSizeOfZero", invalid, "cell size is 0, must be finite and greater than 0", cell_size(0.0)},
        {"TheSmallestCellSizeForItsSupport", ok, "", cell_size(0.015625)},
        {"ACellSizeTooSmallForItsSupport", invalid,
         "spans 266.666667 cells, at most 256 are possible: use a larger cell size", cell_size(0.015)},
        {"AnIsoValueOfZero", invalid, "iso value is 0, must be finite and greater than 0", iso(0.0)},
        {"AnIsoValueThatIsZeroAsFloat32", invalid, "iso value is 1e-50, must be greater than 0 as a float32",
         iso(1e-50)},
        {"AnIsoValueThatIsInfiniteAsFloat32", invalid, "iso value is 1e+300, must be at most 1e+30", iso(1e300)},
        {"AToleranceBelowZero", invalid, "tolerance is -0.1, must be finite and greater than 0",
         settings_with([](v1::Settings& s) { s.mutable_curvature()->set_tolerance(-0.1); })},
        {"ACountThresholdOfZero", invalid, "count threshold is 0, must be at least 1",
         settings_with([](v1::Settings& s) { s.mutable_count()->set_threshold(0); })},
        {"SevenBisectionSteps", ok, "", steps(7)},
        {"EightBisectionSteps", invalid, "bisection steps are 8, must be 1 to 7", steps(8)},
        {"NoBisectionSteps", invalid, "bisection steps are 0, must be 1 to 7", steps(0)},
        {"AFlatDomain", invalid, "domain runs from 1 to 1 along x, must be finite and run upward", domain(1.0, 1.0)},
        {"ADomainThatIsNoNumber", invalid, "domain runs from nan to 1 along x, must be finite and run upward",
         domain(no_number, 1.0)},
        {"AHugeDomain", ok, "", domain(-1e300, 1e300)},
        {"ADomainWithoutACorner", invalid, "settings.domain needs both its corners, min and max",
         settings_with([](v1::Settings& s) { s.mutable_domain()->mutable_max()->set_x(1.0); })},
        {"AnUnknownField", invalid, "settings.field has the value 7, which this version does not know",
         settings_with([](v1::Settings& s) { s.set_field(static_cast<v1::Field>(7)); })},
        {"AnUnknownMode", invalid, "settings.mode has the value 7, which this version does not know",
         settings_with([](v1::Settings& s) { s.set_mode(static_cast<v1::Mode>(7)); })},
        {"ASettingOfAnotherVersion", invalid, "settings have the field 7, which this version does not know",
         settings_with([](v1::Settings& s) { s.GetReflection()->MutableUnknownFields(&s)->AddVarint(7, 1); })},
        {"AParameterOfACriterionOfAnotherVersion", invalid,
         "settings have the field 2, which this version does not know", settings_with([](v1::Settings& s) {
             v1::CountCriterion& count = *s.mutable_count();
             count.GetReflection()->MutableUnknownFields(&count)->AddVarint(2, 1);
         })},
        {"ACreatedSessionWithoutId", invalid, "the message's session id is \"\"; it must be a UUID", id("")},
        {"ACreatedSessionWithAnIdThatMovesTheCursor", invalid,
         "the message's session id is \"a\\u{000a}\\u{001b}[2J\\u{0000}b\\u{009b}\\\\\"; it must be a UUID",
         id(std::string("a\n\x1b[2J\0b\xc2\x9b\\", 11))},
        {"BytesThatAreNoCreateSessionRequest", invalid, "a message of 3 bytes is not a CreateSessionRequest",
         bytes_to("/meniscus.v1.SessionService/CreateSession", "\x0a\x7f!")},
        {"BytesThatAreNoGetSessionRequest", invalid, "a message of 3 bytes is not a GetSessionRequest",
         bytes_to("/meniscus.v1.SessionService/GetSession", "\x0a\x7f!")},
        {"BytesThatAreNoDeleteSessionRequest", invalid, "a message of 3 bytes is not a DeleteSessionRequest",
         bytes_to("/meniscus.v1.SessionService/DeleteSession", "\x0a\x7f!")},
        {"BytesThatAreNoListSessionsRequest", invalid, "a message of 1 bytes is not a ListSessionsRequest",
         bytes_to("/meniscus.v1.SessionService/ListSessions", "\x0a")},
        {"BytesThatAreNoGetServerInfoRequest", invalid, "a message of 1 bytes is not a GetServerInfoRequest",
         bytes_to("/meniscus.v1.ServerService/GetServerInfo", "\x0a")},
        {"BytesThatAreNoListRecordingsRequest", invalid, "a message of 1 bytes is not a ListRecordingsRequest",
         bytes_to("/meniscus.v1.RecordingService/ListRecordings", "\x0a")},
        {"ACreatedSessionThatIsNotTheMetadatas", invalid, "but the message's session id is " + no_session,
         id(no_session)},
        {"AsManySessionsAsTheLimit", ok, "", beside(2)},
        {"ASessionPastTheLimit", grpc::StatusCode::RESOURCE_EXHAUSTED,
         "3 sessions are open; the server holds at most 3", beside(3)},
        {"AsManyAttributesAsTheLimit", ok, "", attributes(16)},
        {"OneAttributePastTheLimit", invalid, "17 attributes, at most 16 are possible", attributes(17)},
        {"AnAttributeTwice", invalid, "the settings name the attribute 'a' twice, must name it once",
         settings_with([](v1::Settings& s) {
             s.add_attributes("a");
             s.add_attributes("a");
         })},
        {"AnAttributeWithoutAName", invalid, "has a name that no array can have",
         settings_with([](v1::Settings& s) { s.add_attributes(""); })},
        {"AnAttributeWhoseNameIsHuge", invalid, "has a name that no array can have",
         settings_with([](v1::Settings& s) { s.add_attributes(std::string(60'000, 'a')); })},
        {"AnAttributeWhoseNameBreaksTheLine", invalid, "has a name that no array can have",
         settings_with([](v1::Settings& s) { s.add_attributes("a\nb"); })},
        {"ThePositionsAsAnAttribute", invalid, "'position' is what the surface is made from",
         settings_with([](v1::Settings& s) { s.add_attributes("position"); })},
        {"AllAttributes", ok, "", settings_with([](v1::Settings& s) { s.set_all_attributes(true); })},
        {"AllAttributesAndOne", invalid, "the settings name 'a' among the attributes and ask for all",
         settings_with([](v1::Settings& s) {
             s.set_all_attributes(true);
             s.add_attributes("a");
         })},
        {"ASessionThatExistsWithOtherAttributes", grpc::StatusCode::ALREADY_EXISTS, "exists with other settings",
         [](RunningServer& running) {
             const CaseSession session(running);
             v1::CreateSessionRequest request;
             request.set_id(session.id);
             *request.mutable_settings() = conversion::to_wire(settings());
             request.mutable_settings()->add_attributes("a");
             return create(running, session.id, request);
         }},
        {"ASessionThatExistsWithOtherSettings", grpc::StatusCode::ALREADY_EXISTS, "exists with other settings",
         exists_with_other_settings},
        {"AnUnknownSessionToDescribe", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         [](RunningServer& running) { return about_no_session(running, &v1::SessionService::Stub::GetSession); }},
        {"AnUnknownSessionToDelete", grpc::StatusCode::NOT_FOUND, "no session " + no_session,
         [](RunningServer& running) { return about_no_session(running, &v1::SessionService::Stub::DeleteSession); }},
    };
}

}  // namespace meniscus::server::test
