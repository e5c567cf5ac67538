# The C++ library as others link it: all rooms in libholomorph.a, and the public headers in include/holomorph.
include(GNUInstallDirs)

set(rooms base linear mesh tiles progressive solver topology forms uv structure tiling flat moduli choice)
set(public holomorph.h)
if(TARGET OpenMeshCore)
  list(APPEND rooms openmesh)
  list(APPEND public openmesh.h)
endif()
list(TRANSFORM rooms REPLACE "(.+)" "$<TARGET_OBJECTS:holomorph_\\1>" OUTPUT_VARIABLE objects)
add_library(holomorph STATIC ${objects})
add_library(holomorph::holomorph ALIAS holomorph)
set_target_properties(holomorph PROPERTIES LINKER_LANGUAGE CXX)
target_compile_features(holomorph PUBLIC cxx_std_20)
# Eigen's templates are compiled on both sides, and the linker keeps either: they must be the same.
target_compile_definitions(holomorph PUBLIC EIGEN_DONT_PARALLELIZE)
target_include_directories(holomorph INTERFACE
  $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(holomorph PUBLIC Eigen3::Eigen Threads::Threads)
if(TARGET OpenMeshCore)
  target_link_libraries(holomorph PUBLIC OpenMeshCore)
endif()
if(TARGET holomorph_cholmod)
  # Where the package is used, holomorph-config.cmake looks for it again.
  target_link_libraries(holomorph INTERFACE
    $<BUILD_INTERFACE:holomorph_cholmod> $<INSTALL_INTERFACE:holomorph::cholmod>)
endif()
if(HOLOMORPH_SANITIZE)
  target_link_options(holomorph PUBLIC -fsanitize=${HOLOMORPH_SANITIZE})
endif()

# The headers that the public ones reach; the others are internal. They name each other from native/src
# ("mesh/surface.h"), and for others from include ("holomorph/mesh/surface.h"): names like mesh are not in their way.
set(staged ${CMAKE_CURRENT_BINARY_DIR}/include/holomorph)
file(REMOVE_RECURSE ${staged}) # of an earlier configuration, with headers that are gone
list(JOIN rooms "|" any_room)
set(reached ${public})
set(waiting ${public})
while(waiting)
  list(POP_FRONT waiting header)
  set(from ${CMAKE_CURRENT_SOURCE_DIR}/src)
  if(header IN_LIST public)
    set(from ${CMAKE_CURRENT_SOURCE_DIR}/include/holomorph)
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${from}/${header})
  file(READ ${from}/${header} text)
  string(REGEX MATCHALL "#include \"(${any_room})/[^\"]+" found "${text}")
  list(TRANSFORM found REPLACE "#include \"" "")
  list(REMOVE_ITEM found ${reached})
  list(APPEND reached ${found})
  list(APPEND waiting ${found})
  string(REGEX REPLACE "#include \"((${any_room})/)" "#include \"holomorph/\\1" text "${text}")
  file(CONFIGURE OUTPUT ${staged}/${header} CONTENT "${text}" @ONLY)
endwhile()
