#include "codec/draco_attributes.hpp"

#include "meniscus/error.hpp"

namespace meniscus {
namespace {

/// Type and components of one point's value.
struct DracoForm {
    draco::DataType type;
    std::uint8_t components;
    bool operator==(const DracoForm&) const = default;
};

/// An id is its four bytes: Draco's integers are int32, and so are the differences of two of them that it codes.
DracoForm draco_form(const CodedAttribute& form) {
    const auto components = static_cast<std::uint8_t>(form.components);
    if (form.bits > 8) return {draco::DT_UINT16, components};
    if (form.bits > 0 || form.type == ElementType::uint8) return {draco::DT_UINT8, components};
    if (is_id(form.type)) return {draco::DT_UINT8, sizeof(std::uint32_t)};
    return {draco::DT_FLOAT32, components};
}

DracoForm form_of(const draco::PointAttribute& attribute) {
    return {attribute.data_type(), static_cast<std::uint8_t>(attribute.num_components())};
}

std::uint32_t id_of(std::size_t place) {
    return first_attribute_id + static_cast<std::uint32_t>(place);
}

bool has(const draco::PointCloud& mesh, draco::GeometryAttribute::Type type, const DracoForm& form) {
    return mesh.NumNamedAttributes(type) == 1 && form_of(*mesh.GetNamedAttribute(type)) == form;
}

}  // namespace

void add_draco_attribute(draco::Mesh& mesh, std::size_t place, const CodedAttribute& form,
                         std::span<const std::byte> coded) {
    const DracoForm as = draco_form(form);
    const std::size_t size = form.coded_bytes();
    draco::GeometryAttribute description;
    description.Init(draco::GeometryAttribute::GENERIC, nullptr, as.components, as.type, false,
                     static_cast<std::int64_t>(size), 0);
    const auto count = static_cast<std::uint32_t>(coded.size() / size);
    draco::PointAttribute& attribute = *mesh.attribute(mesh.AddAttribute(description, true, count));
    attribute.set_unique_id(id_of(place));
    for (std::uint32_t i = 0; i < count; ++i)
        attribute.SetAttributeValue(draco::AttributeValueIndex(i), coded.data() + i * size);
}

std::string misfit(const draco::PointCloud& mesh, std::span<const CodedAttribute> announced) {
    if (!has(mesh, draco::GeometryAttribute::POSITION, {draco::DT_UINT16, 3}))
        return "its Draco mesh has no positions of three uint16";
    const int normals = mesh.NumNamedAttributes(draco::GeometryAttribute::NORMAL);
    if (normals != 0 && !has(mesh, draco::GeometryAttribute::NORMAL, {draco::DT_FLOAT32, 3}))
        return "its Draco mesh has normals that are not three float32";
    const int others = mesh.num_attributes() - 1 - normals;
    if (others != static_cast<int>(announced.size()))
        return "its Draco mesh has " + std::to_string(others) + " attributes, announced were " +
               std::to_string(announced.size());
    for (std::size_t place = 0; place < announced.size(); ++place) {
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id_of(place));
        if (attribute == nullptr || attribute->attribute_type() != draco::GeometryAttribute::GENERIC ||
            form_of(*attribute) != draco_form(announced[place]))
            return "its Draco mesh lacks the attribute '" + announced[place].name +
                   "' as it was announced, with the unique id " + std::to_string(id_of(place));
    }
    return {};
}

std::vector<std::byte> draco_attribute(const draco::Mesh& mesh, std::size_t place, const CodedAttribute& form,
                                       std::span<const std::uint32_t> points) {
    const draco::PointAttribute& attribute = *mesh.GetAttributeByUniqueId(id_of(place));
    const std::size_t size = form.coded_bytes();
    std::vector<std::byte> coded(points.size() * size);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto value = attribute.mapped_index(draco::PointIndex(points[i]));
        if (value.value() >= attribute.size())
            throw InvalidInput("a point names a value of the attribute '" + form.name + "' that is not there");
        attribute.GetValue(value, coded.data() + i * size);
    }
    return coded;
}

}  // namespace meniscus
