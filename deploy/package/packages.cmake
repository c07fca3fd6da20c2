# Debian packages, one for each component: cpack -G DEB.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL server client library development)
if(MENISCUS_WITH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
# Whatever the umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_NAME meniscus)
set(CPACK_PACKAGE_VENDOR "The Meniscus authors")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "Meniscus authors <meniscus@example.org>")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# debian_package(COMPONENT NAME SECTION DESCRIPTION): the name is also that of its folder of documents.
function(debian_package component name section description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}" PARENT_SCOPE)
  install(FILES copyright ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian.gz
    DESTINATION /usr/share/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

debian_package(server meniscusd science "surfaces of simulated fluid particles, live: the server
Meniscus takes streams of particle frames from simulators over gRPC,
reconstructs an adaptive surface of each, and streams compressed meshes back,
to the simulator and to whoever watches.
.
This package has the server, meniscusd, with its viewer for browsers, and a
service for systemd.")
set(CPACK_DEBIAN_SERVER_PACKAGE_SHLIBDEPS ON)
# For the service's user.
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers | systemd-sysusers")
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "meniscus")
set(control ${CMAKE_CURRENT_SOURCE_DIR}/control)
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA ${control}/postinst ${control}/prerm ${control}/postrm ${control}/conffiles)

debian_package(client meniscus science "surfaces of simulated fluid particles: the command line
Meniscus turns frames of SPH particles into adaptive, closed surfaces.
.
This package has the command line, meniscus, which reconstructs by itself or
on a server, watches, draws, compares and converts; and meniscus-load, which
puts load on a server.")
set(CPACK_DEBIAN_CLIENT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SUGGESTS "meniscusd")

# Named after its SONAME, as Debian wants it.
debian_package(library libmeniscus0 libs "surfaces of simulated fluid particles: shared library
Meniscus turns frames of SPH particles into adaptive, closed surfaces, on a
server or in a simulation's own process.
.
This package has the library behind the C interface, for programs that were
built with it.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${control}/library/triggers)
# For the packages of those programs: their dependency on this one follows.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

debian_package(development libmeniscus-dev libdevel "surfaces of simulated fluid particles: development files
Meniscus turns frames of SPH particles into adaptive, closed surfaces, on a
server or in a simulation's own process.
.
This package has the C interface, for pkg-config and CMake (meniscus::c);
headers, static libraries and CMake files of the client library for C++,
meniscus::client, and of the reconstruction, meniscus::core; and examples.")
# And what find_package(Meniscus) looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libmeniscus0 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libgrpc++-dev, protobuf-compiler-grpc, libprotobuf-dev, protobuf-compiler, libdraco-dev, libssl-dev, libtbb-dev")

if(MENISCUS_WITH_PYTHON)
  debian_package(python python3-meniscus python "surfaces of simulated fluid particles: Python package
Meniscus turns frames of SPH particles into adaptive, closed surfaces, on a
server or in a simulation's own process.
.
This package has the module meniscus for Python: numpy arrays of particles in,
numpy arrays of meshes out, in process and through a server, with examples; an
add-on for Blender; and a plugin for ParaView.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The extension is compiled for one minor version of Python.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "meniscusd")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${control}/python/postinst ${control}/python/prerm)
endif()

include(CPack)
