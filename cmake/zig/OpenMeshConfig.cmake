# OpenMesh as the Python module uses it: its headers alone. They are reached by a link, since the computer's own C headers
# lie beside them, which are not those of the platform that is compiled for.
find_path(OPENMESH_HEADERS OpenMesh/Core/Mesh/Handles.hh NO_CMAKE_FIND_ROOT_PATH REQUIRED PATHS /usr/include)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/include)
file(CREATE_LINK ${OPENMESH_HEADERS}/OpenMesh ${CMAKE_BINARY_DIR}/include/OpenMesh SYMBOLIC)
if(NOT TARGET OpenMeshCore)
  add_library(OpenMeshCore INTERFACE IMPORTED)
  target_include_directories(OpenMeshCore INTERFACE ${CMAKE_BINARY_DIR}/include)
endif()
