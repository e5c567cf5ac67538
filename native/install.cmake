# The C++ library as others link it: all rooms in libholomorph.a, headers in include/holomorph, a CMake package.
# Component cpp, which neither the wheel (component native) nor the zips have.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(rooms base linear lattice mesh tiles progressive openmesh solver topology forms conformal uv evening structure tiling turns moduli plane islands multiresolution)
list(TRANSFORM rooms REPLACE "(.+)" "$<TARGET_OBJECTS:holomorph_\\1>" OUTPUT_VARIABLE objects)
add_library(holomorph STATIC ${objects})
set_target_properties(holomorph PROPERTIES LINKER_LANGUAGE CXX)
target_compile_features(holomorph PUBLIC cxx_std_20)
# Eigen's templates are compiled on both sides, and the linker keeps either: they must be the same.
target_compile_definitions(holomorph PUBLIC EIGEN_DONT_PARALLELIZE)
target_include_directories(holomorph INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(holomorph PUBLIC Eigen3::Eigen OpenMeshCore Threads::Threads)
if(TARGET holomorph_cholmod)
  # Where the package is used, holomorph-config.cmake looks for it again.
  target_link_libraries(holomorph INTERFACE $<INSTALL_INTERFACE:holomorph::cholmod>)
  set(HOLOMORPH_USES_CHOLMOD ON)
  if(OPENBLAS_LIBRARY)
    set(HOLOMORPH_USES_OPENBLAS ON)
  endif()
endif()
if(HOLOMORPH_SANITIZE)
  target_link_options(holomorph PUBLIC -fsanitize=${HOLOMORPH_SANITIZE})
endif()

# Headers name each other from native/src ("mesh/surface.h"); installed, from include ("holomorph/mesh/surface.h"), so
# that names like mesh and base are not in the way of others.
set(staged ${CMAKE_CURRENT_BINARY_DIR}/include/holomorph)
list(JOIN rooms "|" any_room)
set(headers "")
foreach(folder src include/holomorph)
  set(from ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
  file(GLOB_RECURSE found RELATIVE ${from} CONFIGURE_DEPENDS ${from}/*.h)
  list(FILTER found EXCLUDE REGEX "^bindings/")
  foreach(header ${found})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${from}/${header})
    file(READ ${from}/${header} text)
    string(REGEX REPLACE "#include \"((${any_room})/)" "#include \"holomorph/\\1" text "${text}")
    file(CONFIGURE OUTPUT ${staged}/${header} CONTENT "${text}" @ONLY)
  endforeach()
endforeach()
install(DIRECTORY ${staged} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT cpp)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/holomorph)
install(TARGETS holomorph EXPORT holomorph ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT cpp)
install(EXPORT holomorph NAMESPACE holomorph:: FILE holomorph-targets.cmake DESTINATION ${package} COMPONENT cpp)
configure_package_config_file(holomorph-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/holomorph-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config-version.cmake
  DESTINATION ${package} COMPONENT cpp)
