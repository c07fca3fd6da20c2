# find_package(Meniscus) gives meniscus::client and meniscus::core, which are static libraries: what they are made of is
# installed with them. Of meniscus::c, which is shared, users need to know nothing. Without the service there is no
# meniscus::client.
include(CMakePackageConfigHelpers)

if(MENISCUS_SERVICE)
  install(TARGETS meniscus_client meniscus_received_frames meniscus_address meniscus_connection meniscus_description meniscus_publication_files meniscus_receiving meniscus_conversion meniscus_message_rows meniscus_proto
          EXPORT MeniscusTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/lib/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
endif()
if(MENISCUS_WITH_CUDA)  # users need no toolkit
  install(FILES $<TARGET_FILE:CUDA::cudart_static> RENAME libmeniscus_cudart.a
          DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Meniscus)
install(EXPORT MeniscusTargets NAMESPACE meniscus:: DESTINATION ${package_directory} COMPONENT development)
install(EXPORT MeniscusSharedTargets NAMESPACE meniscus:: DESTINATION ${package_directory} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/MeniscusConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/MeniscusConfig.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/MeniscusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/MeniscusConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/MeniscusConfigVersion.cmake
        DESTINATION ${package_directory} COMPONENT development)
