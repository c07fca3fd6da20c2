#include "pages/publication_pages.hpp"

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "files/publication_format.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/base64_writer.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/inflate.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"
#include "viewer_files.hpp"

namespace meniscus::pages {
namespace {

/// More than any file of the viewer has.
constexpr std::uint64_t most_viewer_bytes = std::uint64_t{64} << 20;

std::string inflated(std::string_view name, std::span<const unsigned char> gzip) {
    const std::string_view bytes(reinterpret_cast<const char*>(gzip.data()), gzip.size());
    const std::string file(name);
    return formats::inflate(formats::ByteCursor(file, bytes), bytes, formats::Deflate::gzip, most_viewer_bytes, name);
}

std::size_t last_place(std::string_view page, std::string_view of) {
    const std::size_t at = page.rfind(of);
    if (at == std::string_view::npos) throw std::logic_error("the viewer's page has no " + std::string(of));
    return at;
}

}  // namespace

void require_viewer() {
    if (viewer::single_page().empty())
        throw InvalidInput(
            "this meniscus was built without the viewer, since npm was not there: leave out --page and --single-file");
}

void write_site(const std::filesystem::path& publication) {
    require_viewer();
    for (const viewer::File& file : viewer::files()) {
        std::string bytes =
            file.compressed ? inflated(file.path, file.bytes) : std::string(file.bytes.begin(), file.bytes.end());
        const bool is_page = file.path == "/";
        // Hosts of plain files send no policy.
        if (is_page)
            bytes.insert(last_place(bytes, "<title>"),
                         "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
                             std::string(viewer::content_policy) +
                             "\" /><meta name=\"meniscus-publication\" content=\"./\" />");
        const std::filesystem::path path = publication / (is_page ? "index.html" : std::string(file.path.substr(1)));
        formats::make_directory(path.parent_path());
        formats::write_file(path, bytes);
    }
}

SinglePage single_page() {
    require_viewer();
    std::string text = inflated("the viewer's page", viewer::single_page());
    const std::size_t end = last_place(text, "</body>");
    return {.before = text.substr(0, end), .behind = text.substr(end)};
}

void write_single_page(const std::filesystem::path& publication, const std::filesystem::path& page) {
    const SinglePage around = single_page();
    const client::PublicationInfo info = client::Publication(publication).info();
    formats::AtomicFile file(page);
    file.write(around.before);
    const auto add = [&](const std::string& name, std::uint64_t most) {
        file.write("<script type=\"text/plain\" data-file=\"" + name + "\">");
        formats::Base64Writer data(file);
        data.write(formats::read_file(publication / name, most));
        data.finish();
        file.write("</script>\n");
    };
    add(std::string(files::manifest_name), files::max_manifest_bytes);
    for (const client::PublishedSegment& segment : info.segments) add(segment.file(), segment.bytes);
    file.write(around.behind);
    file.commit();
}

}  // namespace meniscus::pages
