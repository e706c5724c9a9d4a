# coast_room(<room> SOURCES <files> [DEPS <targets>]): one static library per room, coast_<room>, alias coast::<room>.
# A wrong include does not link: a room sees only what DEPS names.

# What an installed coast's user gets of them is the include directory alone: our warnings are ours.
add_library(coast_options INTERFACE)
target_include_directories(coast_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
target_compile_features(coast_options INTERFACE cxx_std_20)
target_compile_options(coast_options INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror>)
# Numbers must not depend on the compiler's mood: no contraction to fused multiply-add.
target_compile_options(coast_options INTERFACE $<BUILD_INTERFACE:-ffp-contract=off>)
# Code that may be in a shared library (Python) is optimised as if it were not: nobody replaces our functions at run time.
target_compile_options(coast_options INTERFACE $<BUILD_INTERFACE:-fno-semantic-interposition>)
# It means headers, and takes for one each source that is compiled as a part of several.
target_compile_options(coast_options INTERFACE $<BUILD_INTERFACE:$<$<AND:$<BOOL:${COAST_UNITY}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>>)
# Products of matrices with fixed sizes up to 15 are computed element by element. By default, sizes from 8 on use the blocked
# product for large matrices: at 9 and 12 it takes twice the time, at 15 the same, and several times as long to compile.
target_compile_definitions(coast_options INTERFACE $<BUILD_INTERFACE:EIGEN_CACHEFRIENDLY_PRODUCT_THRESHOLD=16>)
# GCC's collector, at its default, reads a heap of 2 GB again and again: a tenth of the time.
target_compile_options(coast_options INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=4000000>>)
if(COAST_SANITIZE)
  # Left out are checks of pointers, which the address sanitizer makes where they are used: they double Eigen's compile time.
  target_compile_options(coast_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
                         -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
  target_link_options(coast_options INTERFACE -fsanitize=address,undefined)
endif()
if(COAST_FUZZ)
  target_compile_options(coast_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Eigen dominates compile time: parsed once, its decompositions compiled once, for all rooms.
add_library(coast_eigen STATIC src/eigen/decompositions.cpp)
target_link_libraries(coast_eigen PUBLIC coast_options Eigen3::Eigen)
set(coast_decompositions ${PROJECT_SOURCE_DIR}/src/eigen/decompositions.hpp)
file(WRITE ${CMAKE_BINARY_DIR}/pch_anchor.cpp "")
add_library(coast_pch OBJECT ${CMAKE_BINARY_DIR}/pch_anchor.cpp)
target_link_libraries(coast_pch PUBLIC coast_options Eigen3::Eigen fmt::fmt)
target_precompile_headers(coast_pch PRIVATE ${coast_decompositions} <Eigen/Geometry> <fmt/format.h> <algorithm> <array> <cmath>
                          <cstdint> <functional> <map> <memory> <optional> <span> <string> <string_view> <vector>)

function(coast_room room)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPS" ${ARGN})
  add_library(coast_${room} STATIC ${ROOM_SOURCES})
  add_library(coast::${room} ALIAS coast_${room})
  target_link_libraries(coast_${room} PUBLIC coast_options coast_eigen Eigen3::Eigen fmt::fmt ${ROOM_DEPS})
  target_include_directories(coast_${room} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_precompile_headers(coast_${room} REUSE_FROM coast_pch)
endfunction()

# coast_room_tests(<room> SOURCES <files> [DEPS <targets>]): one test program per room, coast_<room>_tests, under CTest.
function(coast_room_tests room)
  cmake_parse_arguments(TESTS "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(coast_${room}_tests ${TESTS_SOURCES})
  target_link_libraries(coast_${room}_tests PRIVATE coast::${room} coast_test_support ${TESTS_DEPS})
  target_include_directories(coast_${room}_tests PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(coast_${room}_tests PRIVATE COAST_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_precompile_headers(coast_${room}_tests REUSE_FROM coast_test_pch)
  # Names by index or by the printer a suite gives: printed bytes of a parameter change from run to run.
  gtest_discover_tests(coast_${room}_tests NO_PRETTY_VALUES DISCOVERY_MODE PRE_TEST PROPERTIES LABELS ${room})
endfunction()

# coast_fuzzers(NAMES <entries> SOURCES <files> [DEPS <targets>]): one libFuzzer program, which tells by the name that it is called
# by, coast_fuzz_<entry>, what it is to read; the corpus is tests/fuzz/corpus/<entry>/. Nothing without COAST_FUZZ.
function(coast_fuzzers)
  if(NOT COAST_FUZZ)
    return()
  endif()
  cmake_parse_arguments(FUZZ "" "" "NAMES;SOURCES;DEPS" ${ARGN})
  add_executable(coast_fuzzer ${FUZZ_SOURCES})
  target_link_libraries(coast_fuzzer PRIVATE coast_options ${FUZZ_DEPS})
  target_link_options(coast_fuzzer PRIVATE -fsanitize=fuzzer)
  foreach(name IN LISTS FUZZ_NAMES)
    add_custom_target(coast_fuzz_${name} ALL
      COMMAND ${CMAKE_COMMAND} -E create_symlink coast_fuzzer $<TARGET_FILE_DIR:coast_fuzzer>/coast_fuzz_${name}
      DEPENDS coast_fuzzer)
  endforeach()
endfunction()
