# CMake's toolchain for HOLOMORPH_PLATFORM, one of the platforms of Blender's extensions, compiled on any by zig: one
# compiler with the headers and C libraries of all of them. The scripts beside this file call the program $ZIG.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HOLOMORPH_PLATFORM)

# The oldest system that the module runs on is part of the target: glibc 2.28 (2018) and macOS 11 (2020), as Blender.
set(windows-x64 Windows AMD64 x86_64-windows-gnu)
set(macos-arm64 Darwin arm64 aarch64-macos.11.0)
set(macos-x64 Darwin x86_64 x86_64-macos.11.0)
set(linux-x64 Linux x86_64 x86_64-linux-gnu.2.28)
set(linux-arm64 Linux aarch64 aarch64-linux-gnu.2.28)
list(GET ${HOLOMORPH_PLATFORM} 0 CMAKE_SYSTEM_NAME)
list(GET ${HOLOMORPH_PLATFORM} 1 CMAKE_SYSTEM_PROCESSOR)
list(GET ${HOLOMORPH_PLATFORM} 2 CMAKE_CXX_COMPILER_TARGET)

set(CMAKE_CXX_COMPILER ${CMAKE_CURRENT_LIST_DIR}/clang++)
set(CMAKE_AR ${CMAKE_CURRENT_LIST_DIR}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${CMAKE_CURRENT_LIST_DIR}/ranlib CACHE FILEPATH "")
# zig's default is to add what a debugger wants.
set(CMAKE_CXX_FLAGS_INIT -g0)
set(CMAKE_MODULE_LINKER_FLAGS_INIT -s)
# Where this is not said, pybind11 tries link time optimization, and zig compiles its C++ library once more for it.
set(CMAKE_INTERPROCEDURAL_OPTIMIZATION OFF)
set(CMAKE_USER_MAKE_RULES_OVERRIDE_CXX ${CMAKE_CURRENT_LIST_DIR}/rules.cmake)

# Nothing of the computer that compiles is used but the templates of Eigen, which are the same everywhere.
set(CMAKE_FIND_ROOT_PATH ${CMAKE_CURRENT_LIST_DIR})
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "")
