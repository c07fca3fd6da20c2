#include <random>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

std::string new_session_id() {
    constexpr const char* digits = "0123456789abcdef";
    std::random_device random;
    // 4 is the version; y, the variant, is one of 8 to b.
    std::string id = "xxxxxxxx-xxxx-4xxx-yxxx-xxxxxxxxxxxx";
    for (char& c : id) {
        if (c == 'x')
            c = digits[random() & 0xFU];
        else if (c == 'y')
            c = digits[8U | (random() & 0x3U)];
    }
    return id;
}

}  // namespace meniscus::client
