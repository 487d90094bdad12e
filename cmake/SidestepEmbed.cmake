include_guard()

# sidestep_embed_files(<target> <header> <name>=<file>...)
#
# Puts files into a program as they are: defines each std::string_view <name> that the header
# declares, within namespace sidestep::<folder of the target>.
function(sidestep_embed_files target header)
  set(files)
  foreach(pair IN LISTS ARGN)
    string(REGEX REPLACE "^[^=]*=" "" file ${pair})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    list(APPEND files ${file})
  endforeach()
  cmake_path(REMOVE_EXTENSION header OUTPUT_VARIABLE name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.cc)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME module)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed.cmake)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D OUT=${source} -D HEADER=sidestep/${module}/${header}
            -D SPACE=sidestep::${module} -D BASE=${CMAKE_CURRENT_SOURCE_DIR} -P ${script} -- ${ARGN}
    DEPENDS ${files} ${script}
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()
