include_guard()
include(GNUInstallDirs)

# What every target of the project is compiled with. Interface only: nothing of it reaches users.
add_library(sidestep_warnings INTERFACE)
target_compile_options(sidestep_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror
                                                   -ffp-contract=off)
# GCC 12 warns of its own std::string concatenation (its bug 105651).
target_compile_options(sidestep_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# Headers are named as they are once installed, "sidestep/<module>/<file>.h": in the tree through
# one link to its root, so that what a header is called never depends on where it is read from.
set(SIDESTEP_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${SIDESTEP_INCLUDE_DIR})
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${SIDESTEP_INCLUDE_DIR}/sidestep SYMBOLIC)

# sidestep_module(<folder> SOURCES <file>... [DEPENDS <public target>...]
#                 [PRIVATE_DEPENDS <target>...])
#
# One folder, one static library, one alias sidestep::<folder>. DEPENDS are the module's arrows;
# tests/architecture_test.cc holds the includes to them. The library, which may be linked into a
# shared one, and the module's headers are installed for other projects.
function(sidestep_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(sidestep_${name} STATIC ${ARG_SOURCES})
  add_library(sidestep::${name} ALIAS sidestep_${name})
  set_target_properties(sidestep_${name} PROPERTIES EXPORT_NAME ${name}
                                                   POSITION_INDEPENDENT_CODE ON)
  target_compile_features(sidestep_${name} PUBLIC cxx_std_20)
  target_include_directories(sidestep_${name} PUBLIC $<BUILD_INTERFACE:${SIDESTEP_INCLUDE_DIR}>
                                                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(
    sidestep_${name}
    PUBLIC ${ARG_DEPENDS}
    PRIVATE $<BUILD_INTERFACE:sidestep_warnings> ${ARG_PRIVATE_DEPENDS})
  sidestep_use_precompiled_headers(sidestep_${name} sidestep_precompiled_module)
  # The same templates are instantiated once a batch, which takes the compiler less than half the
  # time. Only where headers are precompiled: builds without show what a file fails to include.
  set_target_properties(sidestep_${name} PROPERTIES UNITY_BUILD ${SIDESTEP_PRECOMPILE_HEADERS}
                                                   UNITY_BUILD_BATCH_SIZE 12)
  # Highway includes its kernels again for each instruction set, and a program with further planners,
  # predictors, sensors or metrics brings its own registry in place of the library's.
  set(alone ${ARG_SOURCES})
  list(FILTER alone INCLUDE REGEX "(_kernels|registry|^sensors)[.]cc$")
  set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_property(GLOBAL APPEND PROPERTY SIDESTEP_MODULES sidestep_${name})
  install(
    TARGETS sidestep_${name}
    EXPORT sidestep-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(
    DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sidestep
    COMPONENT development
    FILES_MATCHING
    PATTERN "*.h"
    PATTERN "micro" EXCLUDE)
endfunction()

# sidestep_listed_sources(<variable> <list>)
#
# The source files that a list like planner/planners.def names, each once: the last thing in the
# brackets of each line. So a file beside it is compiled by being listed.
function(sidestep_listed_sources variable list)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  file(READ ${list} text)  # and not its lines as a list: their texts may hold semicolons
  string(REGEX MATCHALL "[A-Za-z0-9_/]+[.]cc[)]\n" sources "${text}\n")
  string(REGEX REPLACE "[)]\n" "" sources "${sources}")
  list(REMOVE_DUPLICATES sources)
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# Everything that the thread sanitizer has to see: `./dev test --all` builds it in the tsan preset.
add_custom_target(threaded_tests)

# The tests of the modules, without those of the whole program: `./dev test --sanitize` builds them
# in the asan preset.
add_custom_target(unit_tests)

# Sanitized programs take long to start, and there are thousands of cases.
option(SIDESTEP_WHOLE_TEST_PROGRAMS "ctest runs test programs, not each of their cases" OFF)

# Of the files of tests alone: checks of the compiler that are for what is tested are left out, and
# what runs for moments is optimised less, which takes the compiler a third less time. A larger heap
# before GCC first looks for what it can free takes it a tenth less again.
set(SIDESTEP_TEST_OPTIONS "" CACHE STRING "Compile the files of tests with these options too")

find_program(SIDESTEP_LLD ld.lld)
mark_as_advanced(SIDESTEP_LLD)

# sidestep_test(<folder>/<name>_test [SOURCES <further file>...] DEPENDS <target>...
#               [SLOW | HEAVY | THREADED])
#
# Builds a program of tests/<folder>/<name>_test.cc; ctest runs each of its cases, or the whole
# program at once with SIDESTEP_WHOLE_TEST_PROGRAMS. SLOW cases carry the label "slow", which
# `./dev test` leaves out and `./dev test --all` runs. HEAVY ones, which take long under sanitizers,
# carry the label "heavy", and `./dev test --sanitize` leaves them out. THREADED ones, which start
# threads, carry the label "threaded", and `./dev test --all` runs them under the thread sanitizer.
# Cases in the folder of a module carry the label "unit", or "unit_threaded".
function(sidestep_test path)
  get_filename_component(folder ${path} DIRECTORY)
  string(REPLACE "/" "_" target ${path})
  cmake_parse_arguments(ARG "SLOW;HEAVY;THREADED" "" "SOURCES;DEPENDS" ${ARGN})
  _sidestep_test_program(${target} "${folder}" ${path})
endfunction()

# sidestep_tests(<folder> <name>_test... [SOURCES <further file>...] DEPENDS <target>...
#                [SLOW | HEAVY | THREADED])
#
# The same, of several files that need nothing of their own, as one program, tests_<folder>. Several
# files are compiled as one, which takes the compiler a third less time: so each has its names in a
# namespace that is called as the file is.
function(sidestep_tests folder)
  cmake_parse_arguments(ARG "SLOW;HEAVY;THREADED" "" "SOURCES;DEPENDS" ${ARGN})
  set(target tests_${folder})
  foreach(kind SLOW HEAVY THREADED)
    if(ARG_${kind})
      string(TOLOWER ${target}_${kind} target)
    endif()
  endforeach()
  list(TRANSFORM ARG_UNPARSED_ARGUMENTS PREPEND ${folder}/ OUTPUT_VARIABLE paths)
  _sidestep_test_program(${target} ${folder} ${paths})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SIDESTEP_PRECOMPILE_HEADERS}
                                             UNITY_BUILD_BATCH_SIZE 6)
endfunction()

# A program of tests/<path>.cc, by the arguments of its caller.
function(_sidestep_test_program target folder)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/tests/ OUTPUT_VARIABLE files)
  list(TRANSFORM files APPEND .cc)
  add_executable(${target} ${files} ${ARG_SOURCES})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${target} PRIVATE SIDESTEP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS} GTest::gtest_main GTest::gmock
                                          sidestep_warnings)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE ${SIDESTEP_TEST_OPTIONS})
  sidestep_use_precompiled_headers(${target} sidestep_precompiled_test)
  if(SIDESTEP_LLD)  # takes half the time, some two hundred times
    target_link_options(${target} PRIVATE -fuse-ld=lld)
  endif()
  set(properties TIMEOUT 600)
  if(ARG_SLOW)
    set(properties TIMEOUT 1800 LABELS slow)
  elseif(ARG_HEAVY)
    list(APPEND properties LABELS heavy)
  else()
    set(label)
    if(TARGET sidestep::${folder})
      set(label unit)
    endif()
    if(ARG_THREADED)
      list(APPEND label threaded)
      add_dependencies(threaded_tests ${target})
    endif()
    list(JOIN label _ label)  # one word: lists of labels do not survive the discovery of cases
    if(label)
      list(APPEND properties LABELS ${label})
    endif()
  endif()
  if(TARGET sidestep::${folder} AND NOT ARG_SLOW AND NOT ARG_HEAVY)
    add_dependencies(unit_tests ${target})
  endif()
  if(SIDESTEP_WHOLE_TEST_PROGRAMS)
    add_test(NAME ${target} COMMAND ${target})
    set_tests_properties(${target} PROPERTIES ${properties})
  else()
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST
                         PROPERTIES ${properties})
  endif()
endfunction()
