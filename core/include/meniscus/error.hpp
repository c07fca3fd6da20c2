// The two ways in which a request can be refused, a request that was asked to end, a part that a build lacks, a GPU
// that fails, and a process beside this one that does. Any other exception is a defect.
#pragma once

#include <stdexcept>
#include <string>

namespace meniscus {

/// The caller's input is wrong (a setting, a position, a file). The message names the value and what is allowed.
class InvalidInput : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The input is well formed but larger than a limit. The message names the value, the limit and what to do.
class LimitExceeded : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The memory to be held is more than a limit of it.
class MemoryLimitExceeded : public LimitExceeded {
public:
    using LimitExceeded::LimitExceeded;
};

/// The reconstruction ended early because its StopFlag was raised. The reconstructor may be used on.
class Stopped : public std::runtime_error {
public:
    Stopped() : std::runtime_error("the reconstruction was stopped") {}
};

/// Another process of several that make one surface has failed, or this one has for another reason than those above.
/// The message names its rank. All of them throw it together.
class ProcessFailed : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What is asked for needs a part that this library was built without. The message names both, and how to build it.
class NotBuilt : public std::runtime_error {
public:
    /// without: the part, and where it is to be had, as "OpenSSL: build it where libssl-dev is installed".
    NotBuilt(const std::string& what, const std::string& without)
        : std::runtime_error(what + " is not in this build of Meniscus, which was made without " + without) {}
};

/// A call to CUDA failed. Results on that device are lost. The reconstructor that threw this may be destroyed; it may
/// also be used on: its next frame tries the device afresh.
class DeviceError : public std::runtime_error {
public:
    DeviceError(const std::string& call, const std::string& reason, int device)
        : std::runtime_error("CUDA device " + std::to_string(device) + ": " + call + " failed: " + reason),
          device_(device) {}
    int device() const noexcept { return device_; }

private:
    int device_;
};

}  // namespace meniscus
