#include "web/mesh_request.hpp"

#include <fmt/format.h>

#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view before_session = "/sessions/";
constexpr std::string_view after_session = "/latest.glb";
constexpr std::string_view attribute_is = "attribute=";
constexpr std::string_view all_attributes = "all";

std::string_view path_of(std::string_view target) {
    return target.substr(0, target.find('?'));
}

void add_parameter(std::string_view parameter, MeshRequest& asked) {
    if (parameter == "draco")
        asked.draco = true;
    else if (parameter.starts_with(attribute_is) && parameter != attribute_is)
        asked.attributes.emplace_back(parameter.substr(attribute_is.size()));
    else
        throw InvalidInput(
            fmt::format("the parameter {} is not known; there are draco and attribute=NAME", quoted(parameter, '"')));
}

}  // namespace

bool is_mesh_target(std::string_view target) {
    const std::string_view path = path_of(target);
    return path.size() > before_session.size() + after_session.size() && path.starts_with(before_session) &&
           path.ends_with(after_session);
}

MeshRequest mesh_request(std::string_view target) {
    std::string_view path = path_of(target);
    std::string_view query = target.substr(path.size());
    path.remove_prefix(before_session.size());
    path.remove_suffix(after_session.size());
    MeshRequest asked;
    asked.session = path;
    while (!query.empty()) {
        query.remove_prefix(1);  // the separator
        const std::string_view parameter = query.substr(0, query.find('&'));
        if (!parameter.empty()) add_parameter(parameter, asked);
        query.remove_prefix(parameter.size());
    }
    if (asked.draco && !asked.attributes.empty())
        throw InvalidInput("draco and attribute exclude each other: leave draco out, or the attributes");
    // Names that no attribute has are refused here: they need not even be text.
    conversion::attribute_wishes(snapshot_request(asked).attributes());
    return asked;
}

v1::SnapshotRequest snapshot_request(const MeshRequest& asked) {
    v1::SnapshotRequest request;
    request.set_session_id(asked.session);
    if (!asked.draco) request.add_codecs(v1::CODEC_LATTICE_PACKED);  // it is decoded here
    request.add_codecs(v1::CODEC_DRACO);
    for (const std::string& name : asked.attributes) {
        v1::AttributeWish& attribute = *request.add_attributes();
        if (name != all_attributes) attribute.set_name(name);
        attribute.set_bits(0);
    }
    return request;
}

std::string entity_tag(const MeshRequest& asked, std::string_view instance, const v1::MeshBegin& mesh) {
    if (mesh.run_id() == 0) return {};
    std::string tag =
        fmt::format("\"{}-{:016x}-{}-{}", instance, mesh.run_id(), mesh.frame_index(), asked.draco ? "draco" : "plain");
    for (const std::string& name : asked.attributes) tag += '+' + name;
    return tag + '"';
}

}  // namespace meniscus::server
