#include <boost/uuid/random_generator.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

std::string new_session_id() {
    return to_string(boost::uuids::random_generator()());
}

}  // namespace meniscus::client
