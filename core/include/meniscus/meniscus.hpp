// The whole public interface of the reconstruction library.
#pragma once

#include "meniscus/backend_options.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/devices.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/names.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "meniscus/stop_flag.hpp"
#include "meniscus/warning.hpp"
