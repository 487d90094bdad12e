# What `cmake --install` and CPack deliver: the command with its data, manual and completion (the
# component `command`), and the libraries for other projects (the component `development`), which
# find them by find_package(sidestep) and link sidestep::<module>.
include_guard()
include(CMakePackageConfigHelpers)

install(TARGETS sidestep RUNTIME COMPONENT command)
install(DIRECTORY models scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/sidestep COMPONENT command
        FILES_MATCHING PATTERN "*.yaml" PATTERN "*.xml" PATTERN "*.csv")
set(manual ${PROJECT_BINARY_DIR}/cli/manual)
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT command)
install(FILES ${manual}/completions/sidestep
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT command)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sidestep)
install(EXPORT sidestep-targets NAMESPACE sidestep:: DESTINATION ${package_dir}
        COMPONENT development)
get_property(franka_target GLOBAL PROPERTY SIDESTEP_FRANKA)
set(SIDESTEP_FIND_FRANKA)
if(franka_target)
  set(SIDESTEP_FIND_FRANKA "find_dependency(Franka 0.9)")
endif()
get_property(realsense_target GLOBAL PROPERTY SIDESTEP_REALSENSE)
set(SIDESTEP_FIND_REALSENSE)
if(realsense_target)
  set(SIDESTEP_FIND_REALSENSE "find_dependency(realsense2 2.50)")
endif()
get_property(vision_targets GLOBAL PROPERTY SIDESTEP_VISION)
set(SIDESTEP_FIND_VISION)
set(vision_packages)
if(vision_targets)
  set(SIDESTEP_FIND_VISION
      "include(\${CMAKE_CURRENT_LIST_DIR}/Vision.cmake)\nsidestep_find_vision(_sidestep_vision _why)")
  set(vision_packages ", libapriltag-dev, libopencv-calib3d-dev")
  install(FILES cmake/Vision.cmake DESTINATION ${package_dir} COMPONENT development)
endif()
configure_package_config_file(
  cmake/sidestep-config.cmake.in ${PROJECT_BINARY_DIR}/sidestep-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sidestep-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sidestep-config.cmake
              ${PROJECT_BINARY_DIR}/sidestep-config-version.cmake
        DESTINATION ${package_dir} COMPONENT development)

# Everything that is installed, for whoever does not build the tests.
get_property(modules GLOBAL PROPERTY SIDESTEP_MODULES)
add_custom_target(package_contents)
add_dependencies(package_contents sidestep_manual ${modules})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Sidestep")
set(CPACK_PACKAGE_CONTACT "The Sidestep developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "plan a robot arm's motion around things that move")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL command development)
set(CPACK_CMAKE_BUILD_CONFIG Release)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME sidestep)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "gnuplot-nox") # draws the figures of `reproduce`
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsidestep-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "cmake, pkg-config, libassimp-dev, libavcodec-dev, libavformat-dev, libavutil-dev, libceres-dev, \
libconsole-bridge-dev, libeigen3-dev, libfmt-dev, libhdf5-dev, libhwy-dev, libmujoco-dev, \
libosmesa6-dev, libqhull-dev, libsqlite3-dev, libswscale-dev, libtbb-dev, libtinyxml2-dev, liburdfdom-dev, \
libyaml-cpp-dev, nlohmann-json3-dev${vision_packages}")
include(CPack)
