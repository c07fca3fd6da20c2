// Where the parts of a session's frames find each other.
#pragma once

#include <memory>
#include <mutex>

namespace meniscus::server {

class JointUpload;

struct JointUploads {
    std::mutex mutex;                   ///< held while a stream is opened
    std::weak_ptr<JointUpload> newest;  ///< none once its streams have gone
};

}  // namespace meniscus::server
