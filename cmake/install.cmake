# cmake --install: the program, the rooms as libraries with their headers, the shipped models, runs and scenarios, and what
# find_package(coast) and pkg-config read.
include(CMakePackageConfigHelpers)

install(TARGETS coast_options coast_eigen EXPORT coast)
set_target_properties(coast_options PROPERTIES EXPORT_NAME options)
set_target_properties(coast_eigen PROPERTIES EXPORT_NAME eigen)
list(TRANSFORM coast_job_names PREPEND jobs_ OUTPUT_VARIABLE coast_job_rooms)
foreach(room IN LISTS coast_rooms coast_job_rooms ITEMS jobs)
  install(TARGETS coast_${room} EXPORT coast)
  set_target_properties(coast_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()

set(coast_package ${CMAKE_INSTALL_LIBDIR}/cmake/coast)
install(DIRECTORY include/coast DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/coast)
install(EXPORT coast NAMESPACE coast:: FILE coast-targets.cmake DESTINATION ${coast_package})
# An installed coast finds its libraries as its build did.
install(FILES cmake/dependencies.cmake DESTINATION ${coast_package})
configure_package_config_file(cmake/coast-config.cmake.in ${CMAKE_BINARY_DIR}/coast-config.cmake
                              INSTALL_DESTINATION ${coast_package} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/coast-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/coast-config.cmake ${CMAKE_BINARY_DIR}/coast-config-version.cmake DESTINATION ${coast_package})

# The linker wants a room before those that it uses. cli is the program's.
set(coast_libraries "-lcoast_eigen ")
foreach(room IN LISTS coast_rooms coast_job_rooms)
  string(PREPEND coast_libraries "-lcoast_${room} ")
endforeach()
file(RELATIVE_PATH coast_prefix /x/${CMAKE_INSTALL_LIBDIR}/pkgconfig /x)
configure_file(cmake/coast.pc.in ${CMAKE_BINARY_DIR}/coast.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/coast.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
