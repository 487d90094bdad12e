# Precompiled headers: what nearly every source file includes is read once a build, not once a file.
#
# Only headers from outside the tree, which do not change while one works. They must hide no missing
# include: the preset tsan compiles without them, as does clang-tidy.
include_guard()

option(SIDESTEP_PRECOMPILE_HEADERS "Precompile the standard library, Eigen and the test framework" ON)

# Compiles <name>'s HEADERS. DEPENDS must define no macros: GCC takes a precompiled header only where
# all those hold that it was made with.
function(sidestep_precompiled_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;DEPENDS" ${ARGN})
  set(empty ${PROJECT_BINARY_DIR}/precompiled/empty.cc)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${empty})
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE sidestep_warnings ${ARG_DEPENDS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# Compiles the target's sources on top of these headers.
function(sidestep_use_precompiled_headers target name)
  if(SIDESTEP_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

if(NOT SIDESTEP_PRECOMPILE_HEADERS)
  return()
endif()

# On top of them GCC 12 inlines otherwise and warns of its own std::string concatenation under two
# more names (bug 105651). Builds without them keep both warnings.
target_compile_options(
  sidestep_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-array-bounds>)

set(common <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map>
           <memory> <optional> <sstream> <stdexcept> <string> <utility> <vector> <Eigen/Geometry>)

sidestep_precompiled_headers(sidestep_precompiled_module HEADERS ${common} DEPENDS Eigen3::Eigen)
set_target_properties(sidestep_precompiled_module PROPERTIES POSITION_INDEPENDENT_CODE ON)
if(SIDESTEP_BUILD_TESTS)
  sidestep_precompiled_headers(sidestep_precompiled_test HEADERS ${common} <gmock/gmock.h>
                               DEPENDS Eigen3::Eigen GTest::gmock)
  target_compile_options(sidestep_precompiled_test PRIVATE ${SIDESTEP_TEST_OPTIONS})
endif()
