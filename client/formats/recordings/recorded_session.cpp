#include "formats/recordings/recorded_session.hpp"

#include "conversion/settings_conversion.hpp"
#include "description/label.hpp"
#include "meniscus/error.hpp"
#include "receiving/session_description.hpp"

namespace meniscus::formats {

Settings recorded_settings(const v1::RecordingBegin& begin) {
    Settings settings = conversion::from_wire(begin.settings());
    validate(settings);
    return settings;
}

client::SessionDescription recorded_description(const v1::RecordingBegin& begin) {
    const v1::SessionDescription& wire = begin.description();
    try {
        description::require_name(wire.name());
        description::require_length_unit(wire.length_unit());
        return client::from_wire(wire);
    } catch (const InvalidInput&) {
        return {};
    }
}

}  // namespace meniscus::formats
