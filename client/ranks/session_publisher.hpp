// Publishes a rank's parts to a session of a server, which the makers share.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "meniscus/client/received_frame.hpp"
#include "ranks/brick_upload.hpp"
#include "ranks/parts_options.hpp"
#include "ranks/parts_publisher.hpp"

namespace meniscus::ranks {

class SessionPublisher final : public PartsPublisher {
public:
    explicit SessionPublisher(const PartsArguments& arguments);

    /// Throws as open_brick_upload().
    std::string open(const MakerPlace& place) override;
    /// Waits until all is answered.
    void finish() override;

private:
    /// Opens the session again, if it is not open.
    void show(const LivePart& part) override;
    void leave() noexcept override;
    void open_upload();
    client::ReceivedFrame encoded(const LivePart& part) const;

    std::string server_;
    text_options::Options connection_, session_;
    CodingOptions coding_;
    std::vector<AttributeWish> wishes_;
    Mesh empty_;  ///< of a rank that has no part of a frame
    Statistics of_empty_;
    std::uint64_t run_ = 0;
    std::unique_ptr<BrickUpload> upload_;
};

}  // namespace meniscus::ranks
