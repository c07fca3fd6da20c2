#include "sessions/intake/input_slots.hpp"

#include <utility>

namespace meniscus::server {

InputSlots::InputSlots(const std::shared_ptr<MemoryAccount>& account, const std::shared_ptr<BytesInFlight>& in_flight,
                       const std::shared_ptr<SessionInFlight>& session, const std::shared_ptr<SharedMemory>& memory,
                       const std::shared_ptr<PagePinning>& pinning)
    : inputs_{InputFrame(account, in_flight, session, memory, pinning),
              InputFrame(account, in_flight, session, memory, pinning),
              InputFrame(account, in_flight, session, memory, pinning)} {
    for (std::size_t i = 0; i + 1 < inputs_.size(); ++i) free_.give(inputs_[i]);
}

void InputSlots::give_back(InputFrame& input) {
    input.land();
    if (closed_) input.free_memory();
    if (&input == &third()) {
        const std::lock_guard lock(mutex_);
        if (!third_allowed_) {
            third_in_use_ = false;
            return;
        }
    }
    free_.give(input);
}

bool InputSlots::take_back(InputFrame& input) {
    if (free_.take(input)) return true;
    // The third one is not among the free ones while no stream may use it.
    if (&input != &third()) return false;
    const std::lock_guard lock(mutex_);
    return !std::exchange(third_in_use_, true);
}

void InputSlots::release_memory() {
    for (InputFrame& input : inputs_) {
        if (!take_back(input)) continue;
        input.free_memory();
        give_back(input);
    }
}

void InputSlots::close() {
    closed_ = true;
    free_.close();
}

void InputSlots::allow_third(bool allowed) {
    const std::lock_guard lock(mutex_);
    third_allowed_ = allowed;
}

void InputSlots::lend_third() {
    {
        const std::lock_guard lock(mutex_);
        if (!third_allowed_ || std::exchange(third_in_use_, true)) return;
    }
    free_.give(third());
}

}  // namespace meniscus::server
