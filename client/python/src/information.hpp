// The descriptions that a server sends, as the keywords of the classes in meniscus/information.py.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/client/recording.hpp"
#include "meniscus/client/server_info.hpp"
#include "meniscus/client/session_info.hpp"

namespace meniscus::python {

pybind11::dict to_dict(const client::ServerInfo& server);
pybind11::dict to_dict(const client::SessionInfo& session);
pybind11::dict to_dict(const client::RecordingInfo& recording);

}  // namespace meniscus::python
