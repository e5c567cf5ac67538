// Holomorph for programs that keep their meshes in OpenMesh: any TriMesh_ArrayKernelT or PolyMesh_ArrayKernelT.
//
//   holomorph::Execution execution;
//   for (const auto& part : holomorph::openmesh::components(holomorph::openmesh::to_surface(mesh, execution),
//   execution)) {
//     const auto map = holomorph::structure::balanced_map(part.surface, {}, execution);
//     holomorph::openmesh::write_uv(mesh, part, map.uv);  // half-edge texture coordinates
//     holomorph::openmesh::mark_seams(mesh, part, map.structure.topology.seams);  // the feature bit of edges
//   }
#pragma once

#include "openmesh/attributes.h"
#include "openmesh/progmesh_records.h"
#include "openmesh/surface_of_mesh.h"
