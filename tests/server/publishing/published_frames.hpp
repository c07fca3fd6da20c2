// Encoded frames for publications, whose bricks are bytes of no codec: nobody decodes them here.
#pragma once

#include <google/protobuf/util/json_util.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/v1/publication.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "publishing/publication.hpp"

namespace meniscus::server::test {

/// A frame of one brick for each text, at (0, 0, i); equal texts are equal bricks.
inline EncodedFrame encoded_frame(std::uint64_t index, const std::vector<std::string>& bricks, std::uint64_t run = 7) {
    EncodedFrame frame;
    frame.index = index;
    frame.run_id = run;
    frame.simulation_time = 0.5 * static_cast<double>(index);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        v1::StreamResponse message;
        message.mutable_mesh_brick()->set_data(bricks[i]);
        auto brick = std::make_shared<BrickMessages>();
        brick->place = {0, 0, static_cast<std::int32_t>(i)};
        brick->content_hash = {std::hash<std::string>()(bricks[i]), bricks[i].size()};
        brick->messages.push_back(std::make_shared<const std::string>(message.SerializeAsString()));
        brick->bytes = brick->messages.front()->size();
        frame.bricks.push_back(std::move(brick));
    }
    v1::StreamResponse end;
    end.mutable_frame_statistics()->set_frame_index(index);
    frame.end = std::make_shared<const std::string>(end.SerializeAsString());
    return frame;
}

inline v1::Publication manifest_of(const Publication& publication) {
    v1::Publication manifest;
    const auto file = publication.find("manifest.json");
    if (!file || !google::protobuf::util::JsonStringToMessage(file->bytes, &manifest).ok())
        throw std::runtime_error("there is no manifest");
    return manifest;
}

}  // namespace meniscus::server::test
