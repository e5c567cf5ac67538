# The C++ library installed: libholomorph.a, its headers, a CMake package, a file for pkg-config. Component cpp, which
# neither the wheel (component native) nor the zips have.
include(CMakePackageConfigHelpers)

if(TARGET OpenMeshCore)
  set(HOLOMORPH_USES_OPENMESH ON)
endif()
if(TARGET holomorph_cholmod)
  set(HOLOMORPH_USES_CHOLMOD ON)
  if(OPENBLAS_LIBRARY)
    set(HOLOMORPH_USES_OPENBLAS ON)
  endif()
endif()
install(DIRECTORY ${staged} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT cpp)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/holomorph)
install(TARGETS holomorph EXPORT holomorph ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT cpp)
install(EXPORT holomorph NAMESPACE holomorph:: FILE holomorph-targets.cmake DESTINATION ${package} COMPONENT cpp)
configure_package_config_file(holomorph-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/holomorph-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/holomorph-config-version.cmake
  DESTINATION ${package} COMPONENT cpp)

set(libraries -pthread)
if(TARGET OpenMeshCore)
  list(APPEND libraries -lOpenMeshCore)
endif()
if(TARGET holomorph_cholmod)
  # In this order, and OpenBLAS kept although nothing names its symbols: so CHOLMOD finds its kernels.
  list(APPEND libraries -Wl,--no-as-needed ${OPENBLAS_LIBRARY} ${CHOLMOD_LIBRARY})
endif()
list(JOIN libraries " " libraries)
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(holomorph.pc.in holomorph.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holomorph.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT cpp)
