# Libfranka for the Panda, if it is found: 0.9, whose protocol and limits are the Panda's. 0.10 and
# later are for another robot, the FR3, and call themselves compatible with 0.9.
#
# Sets `target` to what is to be linked, or to nothing and `why` to the reason.
macro(sidestep_find_libfranka target why)
  set(${target})
  set(${why} "no libfranka 0.9 was found")
  find_package(Franka QUIET)
  if(Franka_FOUND AND Franka_VERSION VERSION_GREATER_EQUAL 0.9 AND Franka_VERSION VERSION_LESS 0.10)
    set(${target} Franka::Franka)
  elseif(Franka_FOUND)
    set(${why} "libfranka ${Franka_VERSION} is not for the Panda, which needs 0.9.1 or 0.9.2")
  endif()
endmacro()
