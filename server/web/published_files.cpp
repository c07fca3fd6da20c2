#include "web/published_files.hpp"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "files/publication_format.hpp"
#include "meniscus/error.hpp"
#include "rpc/calls/status.hpp"
#include "rpc/messages/session_id.hpp"
#include "sessions/limits/refusal.hpp"
#include "web/byte_range.hpp"
#include "web/latest_mesh.hpp"

namespace meniscus::server {

namespace {

constexpr std::string_view below = "/publications/";

Refusal not_there(const std::string& what) {
    return {Refusal::Kind::not_found, what};
}

/// The names in a target.
struct FileName {
    std::string_view session;
    std::string_view file;
};

/// Throws InvalidInput for what no link to a file has, Refusal (not_found) for what cannot be one.
FileName name_of(std::string_view target) {
    if (target.find_first_of("?%\\") != std::string_view::npos || target.find("..") != std::string_view::npos)
        throw InvalidInput(
            "the files of a publication are /publications/ID/manifest.json and the segments that it names; addresses "
            "have no parameters, no escapes and no dots beside these");
    target.remove_prefix(below.size());
    const std::size_t slash = target.find('/');
    if (slash == std::string_view::npos || !is_session_id(target.substr(0, slash)))
        throw not_there(
            "there is no such publication: its address is /publications/ID/manifest.json, the id of the session in "
            "8-4-4-4-12 lower-case hexadecimal digits");
    return {.session = target.substr(0, slash), .file = target.substr(slash + 1)};
}

/// Whether a header that lists tags has this one, or is for any.
bool names(std::string_view header, std::string_view tag) {
    return header == "*" || header.find(tag) != std::string_view::npos;
}

}  // namespace

bool is_published_target(std::string_view target) {
    return target.starts_with(below);
}

PublishedFiles::PublishedFiles(const Publications* publications, const Authorizer& authorizer, bool needs_certificate)
    : publications_(publications), authorizer_(authorizer), needs_certificate_(needs_certificate) {}

Page PublishedFiles::answer(const FileRequest& request) const {
    try {
        if (publications_ == nullptr)
            throw not_there("this server publishes nothing: it was not started with --publish");
        const FileName name = name_of(request.target);
        const Caller caller = authorizer_.admit(request.authorization, request.peer, Action::watch);
        const auto publication = publications_->find(name.session);
        if (!publication || !Authorizer::may_see(caller, publication->owner()))
            throw not_there(fmt::format("session {} is not published", name.session));
        const std::shared_ptr<const PublishedFile> file = publication->find(name.file);
        if (!file)
            throw not_there(
                fmt::format("the publication has no such file, or no longer: its segments are those of "
                            "/publications/{}/{}",
                            name.session, files::manifest_name));
        return found(file, name.file == files::manifest_name, request);
    } catch (...) {
        return page_of(to_status(std::current_exception()));
    }
}

Page PublishedFiles::found(const std::shared_ptr<const PublishedFile>& file, bool is_manifest,
                           const FileRequest& request) const {
    const std::string tag = '"' + file->sha256 + '"';
    const bool is_private = needs_certificate_ || authorizer_.asks_for_tokens();
    Page page{.content_type = is_manifest ? "application/json" : "application/octet-stream"};
    page.cache_control = is_private ? "private, " : "";
    page.cache_control += is_manifest ? "max-age=1" : "max-age=31536000, immutable";
    page.headers = {
        {"ETag", tag}, {"Accept-Ranges", "bytes"}, {"Vary", is_private ? "Origin, Authorization" : "Origin"}};
    if (names(request.if_none_match, tag)) {
        page.status = 304;
        return page;
    }
    std::string_view bytes = file->bytes;
    if (!request.whole && (request.if_range.empty() || request.if_range == tag)) {
        if (const auto range = byte_range(request.range, bytes.size())) {
            page.status = range->length != 0 ? 206 : 416;
            page.headers.emplace_back("Content-Range", range->length != 0
                                                           ? fmt::format("bytes {}-{}/{}", range->first,
                                                                         range->first + range->length - 1, bytes.size())
                                                           : fmt::format("bytes */{}", bytes.size()));
            bytes = bytes.substr(range->first, range->length);
        }
    }
    if (page.status == 416) {
        page.cache_control = "no-store";
        page.content_type = "text/plain; charset=utf-8";
        page.body = fmt::format("The range is not in the file, which has {} bytes.\n", file->bytes.size());
        return page;
    }
    if (!is_manifest && !request.whole && !publications_->may_be_sent())
        return {.status = 503,
                .body = "Slow readers hold too much of segments that have left their publications: try again later.\n"};
    if (!request.whole) file->counters->sent += bytes.size();
    page.lasting_body = bytes;
    page.memory = file;
    return page;
}

}  // namespace meniscus::server
