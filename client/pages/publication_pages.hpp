// A publication as a web site, or as one page.
#pragma once

#include <filesystem>
#include <string>

namespace meniscus::pages {

/// Puts the viewer beside the publication's files, so that the folder is a web site. Throws InvalidInput where this
/// program was built without the viewer, std::runtime_error if writing fails.
void write_site(const std::filesystem::path& publication);

/// Writes the viewer and all files of the publication as one page, which opens without a server and without a network.
/// Throws as write_site() does, and InvalidInput for a publication that cannot be read.
void write_single_page(const std::filesystem::path& publication, const std::filesystem::path& page);

/// The viewer as one page: the parts before and behind a publication's files, each of which stands between them as
/// <script type="text/plain" data-file="NAME">BASE64</script>.
struct SinglePage {
    std::string before;
    std::string behind;
};
/// Throws InvalidInput where this program was built without the viewer.
SinglePage single_page();

/// Throws InvalidInput where this program was built without the viewer: to be called before long work.
void require_viewer();

}  // namespace meniscus::pages
