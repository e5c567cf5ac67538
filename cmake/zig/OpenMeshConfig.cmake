# OpenMesh as the Python module uses it: its headers alone. They are reached by a link, since the computer's own C headers
# lie beside them, which are not those of the platform that is compiled for. All builds share the link: with one name for
# a header, ccache finds for the second Python what it compiled for the first.
find_path(OPENMESH_HEADERS OpenMesh/Core/Mesh/Handles.hh NO_CMAKE_FIND_ROOT_PATH REQUIRED PATHS /usr/include)
set(openmesh_include ${PROJECT_SOURCE_DIR}/build/platforms/include)
file(MAKE_DIRECTORY ${openmesh_include})
file(CREATE_LINK ${OPENMESH_HEADERS}/OpenMesh ${openmesh_include}/OpenMesh SYMBOLIC)
if(NOT TARGET OpenMeshCore)
  add_library(OpenMeshCore INTERFACE IMPORTED)
  target_include_directories(OpenMeshCore INTERFACE ${openmesh_include})
endif()
