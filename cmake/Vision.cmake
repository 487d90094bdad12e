# Debian's libapriltag and OpenCV, if they are found. Debian's OpenCV has a CMake package only with
# all of its parts (libopencv-dev); three of them are enough here.
#
# Sets `targets` to what is to be linked, or to nothing and `why` to the reason.
macro(sidestep_find_vision targets why)
  set(${targets})
  set(${why} "no libapriltag-dev and libopencv-calib3d-dev were found")
  find_path(SIDESTEP_APRILTAG_INCLUDE apriltag/tag36h11.h)
  find_library(SIDESTEP_APRILTAG_LIBRARY apriltag)
  find_path(SIDESTEP_OPENCV_INCLUDE opencv2/calib3d.hpp PATH_SUFFIXES opencv4)
  find_library(SIDESTEP_OPENCV_CALIB3D opencv_calib3d)
  find_library(SIDESTEP_OPENCV_CORE opencv_core)
  if(SIDESTEP_APRILTAG_INCLUDE AND SIDESTEP_APRILTAG_LIBRARY AND SIDESTEP_OPENCV_INCLUDE
     AND SIDESTEP_OPENCV_CALIB3D AND SIDESTEP_OPENCV_CORE)
    if(NOT TARGET sidestep::vision)
      add_library(sidestep::vision INTERFACE IMPORTED)
      target_include_directories(sidestep::vision SYSTEM INTERFACE ${SIDESTEP_APRILTAG_INCLUDE}
                                                                   ${SIDESTEP_OPENCV_INCLUDE})
      target_link_libraries(
        sidestep::vision INTERFACE ${SIDESTEP_APRILTAG_LIBRARY} ${SIDESTEP_OPENCV_CALIB3D}
                                   ${SIDESTEP_OPENCV_CORE})
    endif()
    set(${targets} sidestep::vision)
  endif()
endmacro()
