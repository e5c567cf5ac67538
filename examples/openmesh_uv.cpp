// openmesh_uv IN OUT.obj: the conformal UV map of every part of a mesh that OpenMesh reads, as texture coordinates.
#include <holomorph/holomorph.h>
#include <holomorph/openmesh.h>

// Readers and writers before meshes, as OpenMesh asks for.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <iostream>

using Mesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

static void map_part(Mesh& mesh, const holomorph::openmesh::SurfaceOfMesh& part, holomorph::Execution& execution) {
  const auto map = holomorph::structure::balanced_map(part.surface, {}, execution);
  holomorph::openmesh::write_uv(mesh, part, map.uv);
  holomorph::openmesh::mark_seams(mesh, part, map.structure.topology.seams);
  std::cout << map.structure.topology.type.text() << ", " << map.structure.topology.seams.size() << " seam edges\n";
}

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: openmesh_uv IN OUT.obj\n";
    return 2;
  }
  Mesh mesh;
  if (!OpenMesh::IO::read_mesh(mesh, argv[1])) {
    std::cerr << "cannot read " << argv[1] << "\n";
    return 1;
  }
  try {
    holomorph::Execution execution;
    const auto surface = holomorph::openmesh::to_surface(mesh, execution);
    for (const auto& part : holomorph::openmesh::components(surface, execution)) map_part(mesh, part, execution);
  } catch (const holomorph::Error& error) {
    std::cerr << argv[1] << ": " << error.what() << "\n";
    return 1;
  }
  if (!OpenMesh::IO::write_mesh(mesh, argv[2], OpenMesh::IO::Options::FaceTexCoord, 9)) {
    std::cerr << "cannot write " << argv[2] << "\n";
    return 1;
  }
}
