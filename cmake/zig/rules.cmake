# CMake asks macOS's linker for a bundle, on which zig's stops; Python loads a shared library as well.
if(APPLE)
  set(CMAKE_SHARED_MODULE_CREATE_CXX_FLAGS "-shared")
endif()
