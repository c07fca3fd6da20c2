// An upload of encoded frames: by the client library, or by `meniscus push` in a build without the service.
#pragma once

#include <memory>
#include <string>

#include "meniscus/client/received_frame.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::ranks {

class BrickUpload {
public:
    /// Ends the session if this has made it, unless it was left.
    virtual ~BrickUpload() = default;
    virtual const std::string& session_id() const = 0;
    /// Waits while the server does not take more. Throws what the server has said, here and below.
    virtual void push(const client::ReceivedFrame& frame) = 0;
    /// Waits until all is answered.
    virtual void finish() = 0;
    virtual void leave() noexcept = 0;
};

/// connection, session: options of a connection, and of a publisher and its session. Throws InvalidInput or
/// client::ServerError, or NotBuilt for what `meniscus push` cannot do.
std::unique_ptr<BrickUpload> open_brick_upload(const std::string& server, const text_options::Options& connection,
                                               const text_options::Options& session);

}  // namespace meniscus::ranks
