// A publication's manifest to JSON and back.
#pragma once

#include <string>
#include <string_view>

#include "meniscus/client/publication.hpp"

namespace meniscus::client {

/// The text of manifest.json. settings: as the publication has had them, if this version does not understand them.
std::string manifest_text(const PublicationInfo& info);

/// Throws InvalidInput, "NAME: ...", for anything else than a manifest of a version that this one reads, and for one
/// that contradicts itself.
PublicationInfo read_manifest(const std::string& name, std::string_view text);

}  // namespace meniscus::client
