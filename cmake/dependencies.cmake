# Everything here is a Debian 12 package of tools/packages.txt; tests have their own list, tools/test-packages.txt.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)
find_package(GeographicLib REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(FastFloat REQUIRED)
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(PROJ CONFIG REQUIRED)
find_package(Threads REQUIRED)

# CHOLMOD of Debian 12 comes without files for CMake.
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
add_library(coast_cholmod INTERFACE IMPORTED)
target_include_directories(coast_cholmod INTERFACE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(coast_cholmod INTERFACE ${CHOLMOD_LIBRARY})

# LZ4 of Debian 12 has none either; Zstandard's target has another name where it is built otherwise.
foreach(codec lz4 zstd)
  find_library(${codec}_LIBRARY ${codec} REQUIRED)
  find_path(${codec}_INCLUDE_DIR ${codec}.h REQUIRED)
  add_library(coast_${codec} INTERFACE IMPORTED)
  target_include_directories(coast_${codec} INTERFACE ${${codec}_INCLUDE_DIR})
  target_link_libraries(coast_${codec} INTERFACE ${${codec}_LIBRARY})
endforeach()

# FindGeographicLib gives variables; an imported target keeps its headers out of our warnings and out of what is installed.
add_library(coast_geographiclib INTERFACE IMPORTED)
target_include_directories(coast_geographiclib INTERFACE ${GeographicLib_INCLUDE_DIRS})
target_link_libraries(coast_geographiclib INTERFACE ${GeographicLib_LIBRARIES})
