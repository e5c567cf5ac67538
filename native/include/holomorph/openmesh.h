// Holomorph for programs that keep their meshes in OpenMesh: any TriMesh_ArrayKernelT or PolyMesh_ArrayKernelT.
//
//   using namespace holomorph;
//   Execution execution;
//   for (const auto& part : openmesh::components(openmesh::to_surface(mesh, execution), execution)) {
//     const auto map = structure::balanced_map(part.surface, {}, execution);
//     openmesh::write_uv(mesh, part, map.uv);  // half-edge texture coordinates
//     openmesh::mark_seams(mesh, part, map.structure.topology.seams);  // the feature bit of edges
//   }
#pragma once

#include "openmesh/progmesh_records.h"
#include "openmesh/surface_of_mesh.h"
