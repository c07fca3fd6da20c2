// The list of a frame's arrays: too many, twice, of another form than they have, missing.
#include <gtest/gtest.h>

#include <utility>

#include "rpc/bad_input/case.hpp"

namespace meniscus::server::test {

namespace {

struct Array {
    std::string name;
    int type;
    std::uint32_t components;
};

const Array positions{"position", v1::ELEMENT_TYPE_FLOAT32, 3};
const Array levels{"level", v1::ELEMENT_TYPE_UINT8, 1};
const Array velocity{"velocity", v1::ELEMENT_TYPE_FLOAT32, 3};
const Array other_number{"other", v1::ELEMENT_TYPE_INT32, 1};

v1::StreamRequest begin_of(const std::vector<Array>& list) {
    v1::StreamRequest request = frame_begin(0);
    request.mutable_frame_begin()->clear_arrays();
    for (const Array& array : list) {
        v1::ParticleArray& wire = *request.mutable_frame_begin()->add_arrays();
        wire.set_name(array.name);
        wire.set_type(static_cast<v1::ElementType>(array.type));
        wire.set_components(array.components);
    }
    return request;
}

/// A frame without particles that announces these arrays.
std::function<grpc::Status(RunningServer&)> arrays(std::vector<Array> list) {
    return after_a_good_frame([list = std::move(list)](RawStream& s) {
        s.call->Write(begin_of(list));
        s.send_end();
    });
}

/// Sends one particle with these arrays and bytes, in a session that makes an attribute of "velocity".
std::function<grpc::Status(RunningServer&)> arrays_for_velocity(std::vector<Array> list, std::string bytes = {}) {
    return [list = std::move(list), bytes = std::move(bytes)](RunningServer& running) {
        Settings with = settings();
        with.attributes = {"velocity"};
        const std::string id = client::new_session_id();
        running.client.create_session(id, with);
        RawStream stream(running.server.address(), id);
        v1::StreamRequest begin = begin_of(list);
        begin.mutable_frame_begin()->set_particle_count(1);
        stream.call->Write(begin);
        stream.send_data(bytes);
        stream.send_end();
        stream.call->WritesDone();
        grpc::Status status = stream.finish();
        EXPECT_EQ(stream.answered, status.ok() ? 1 : 0);
        running.client.delete_session(id);
        return status;
    };
}

/// Positions, and this number of other arrays.
std::vector<Array> positions_and(int others) {
    std::vector<Array> list{positions};
    for (int i = 0; i < others; ++i) list.push_back({"other_" + std::to_string(i), v1::ELEMENT_TYPE_INT32, 1});
    return list;
}

}  // namespace

std::vector<BadInputCase> array_cases() {
    return {
        {"PositionsAlone", ok, "", arrays({positions})},
        {"PositionsAndLevels", ok, "", arrays({positions, levels})},
        {"NoArrays", invalid, "frame 11: no arrays; the first must be 'position'", arrays({})},
        {"LevelsAlone", invalid, "frame 11: the first array is 'level'; it must be 'position'", arrays({levels})},
        {"LevelsBeforePositions", invalid, "frame 11: the first array is 'level'; it must be 'position'",
         arrays({levels, positions})},
        {"PositionsTwice", invalid, "frame 11: array 'position' comes twice; each comes once",
         arrays({positions, positions})},
        {"LevelsTwice", invalid, "frame 11: array 'level' comes twice; each comes once",
         arrays({positions, levels, levels})},
        {"AnArrayThatTheSessionDoesNotName", ok, "", arrays({positions, {"velocity", v1::ELEMENT_TYPE_FLOAT32, 3}})},
        {"PositionsOfTwoComponents", invalid,
         "frame 11: array 'position' is float32 of 2 components; it must be float32 of 3 components or uint16 of 3 "
         "components",
         arrays({{"position", v1::ELEMENT_TYPE_FLOAT32, 2}})},
        {"PositionsOfInt32", invalid,
         "frame 11: array 'position' is int32 of 3 components; it must be float32 of 3 components or uint16 of 3 "
         "components",
         arrays({{"position", v1::ELEMENT_TYPE_INT32, 3}})},
        {"LevelsOfUint32", invalid, "frame 11: array 'level' is uint32 of 1 component; it must be uint8 of 1 component",
         arrays({positions, {"level", v1::ELEMENT_TYPE_UINT32, 1}})},
        {"AnElementTypeOfTheFuture", invalid,
         "frame 11: array 'position' has the element type 6, which this version does not know",
         arrays({{"position", 6, 3}})},
        {"AnElementTypeBelowZero", invalid, "frame 11: array 'level' has the element type -1",
         arrays({positions, {"level", -1, 1}})},
        {"NoElementType", invalid, "frame 11: array 'position' has the element type 0",
         arrays({{"position", v1::ELEMENT_TYPE_UNSPECIFIED, 3}})},
        {"NoComponents", invalid, "frame 11: array 'position' has 0 components; it must have 1 to 16",
         arrays({{"position", v1::ELEMENT_TYPE_FLOAT32, 0}})},
        {"OneComponentTooMany", invalid, "frame 11: array 'other' has 17 components; it must have 1 to 16",
         arrays({positions, {"other", v1::ELEMENT_TYPE_UINT8, 17}})},
        {"AnArrayWithoutAName", invalid, "frame 11: the name of array 1 has 0 bytes; it must have 1 to 64",
         arrays({positions, {"", v1::ELEMENT_TYPE_UINT8, 1}})},
        {"TheLongestName", ok, "", arrays({positions, {std::string(64, 'a'), v1::ELEMENT_TYPE_UINT8, 1}})},
        {"ANameThatIsTooLong", invalid, "frame 11: the name of array 1 has 65 bytes; it must have 1 to 64",
         arrays({positions, {std::string(65, 'a'), v1::ELEMENT_TYPE_UINT8, 1}})},
        {"ANameThatBreaksTheLine", invalid,
         "frame 11: the name of array 1 has the byte 10; it must be of a-z, 0-9 and _",
         arrays({positions, {"level\n", v1::ELEMENT_TYPE_UINT8, 1}})},
        {"AsManyArraysAsTheLimit", ok, "", arrays(positions_and(17))},
        {"AnAttributesArray", ok, "", arrays_for_velocity({positions, other_number, velocity}, std::string(28, '\0'))},
        {"AnAttributesArrayThatIsNotFinite", invalid, "velocity",
         arrays_for_velocity({positions, other_number, velocity}, std::string(16, '\0') + std::string(12, '\xff'))},
        {"AnAttributesArrayThatIsMissing", invalid,
         "frame 11: no array 'velocity', which the session's settings name as an attribute; the frame's further "
         "arrays are 'other'",
         arrays_for_velocity({positions, levels, other_number})},
        {"AnAttributesArrayThatComesTwice", invalid, "frame 11: array 'velocity' comes twice; each comes once",
         arrays_for_velocity({positions, velocity, velocity})},
        {"AnAttributesArrayOfAnotherLength", invalid, "frame 11: 24 bytes for 1 particles; 28 were announced",
         arrays_for_velocity({positions, other_number, velocity}, std::string(24, '\0'))},
        {"AnAttributesArrayOfUint16", invalid,
         "frame 11: array 'velocity' is uint16 of 3 components, and the session's settings name it as an attribute; "
         "that is "
         "float32 or uint8 of 1, 3 or 4 components, or int32 or uint32 of 1",
         arrays_for_velocity({positions, {"velocity", v1::ELEMENT_TYPE_UINT16, 3}})},
        {"AnAttributesArrayOfTwoComponents", invalid, "frame 11: array 'velocity' is float32 of 2 components, and",
         arrays_for_velocity({positions, {"velocity", v1::ELEMENT_TYPE_FLOAT32, 2}})},
        {"IdsOfThreeComponents", invalid, "frame 11: array 'velocity' is uint32 of 3 components, and",
         arrays_for_velocity({positions, {"velocity", v1::ELEMENT_TYPE_UINT32, 3}})},
        {"AnAttributesArrayOfMoreComponentsThanThereAre", invalid,
         "frame 11: array 'velocity' has 4294967295 components; it must have 1 to 16",
         arrays_for_velocity({positions, {"velocity", v1::ELEMENT_TYPE_FLOAT32, 0xFFFFFFFFU}})},
        {"OneArrayPastTheLimit", invalid, "frame 11: 19 arrays; at most 18 are taken", arrays(positions_and(18))},
    };
}

}  // namespace meniscus::server::test
