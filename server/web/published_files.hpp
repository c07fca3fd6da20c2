// GET /publications/ID/FILE: the files of sessions' publications, for callers that may watch these sessions.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "publishing/publications.hpp"
#include "security/authorizer.hpp"
#include "security/peer_address.hpp"
#include "web/page.hpp"

namespace meniscus::server {

/// The parts of a request that a file's answer depends on. Headers are as they came; empty: not sent.
struct FileRequest {
    std::string_view target;
    bool whole = false;  ///< a range is not looked at: of HEAD
    std::string_view if_none_match;
    std::string_view range;
    std::string_view if_range;
    std::span<const std::string_view> authorization;  ///< the values of that header
    PeerAddress peer;
};

/// Whether the target of a request, as in its first line, is below /publications/, whatever stands there.
bool is_published_target(std::string_view target);

/// Answers from memory, without a call of gRPC. Thread-safe.
class PublishedFiles {
public:
    /// publications: null where the server publishes nothing. needs_certificate: a client's. All outlive this object.
    PublishedFiles(const Publications* publications, const Authorizer& authorizer, bool needs_certificate);

    Page answer(const FileRequest& request) const;

private:
    Page found(const std::shared_ptr<const PublishedFile>& file, bool is_manifest, const FileRequest& request) const;

    const Publications* publications_;
    const Authorizer& authorizer_;
    const bool needs_certificate_;
};

}  // namespace meniscus::server
