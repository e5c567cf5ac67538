// Conformal UV maps from holomorphic one-forms: what a C++ program needs. holomorph/openmesh.h takes OpenMesh meshes.
//
//   using namespace holomorph;
//   Execution execution;  // threads and, if you like, a progress function
//   const structure::Options options;
//   const auto surface = mesh::make_surface(mesh::read("kitten.obj"), execution);
//   const auto part = std::make_shared<mesh::Surface>(mesh::component(surface, 0, execution).surface);
//   auto found = structure::conformal_structure(part, options, execution);  // e.g. its period matrix
//   const auto forms = structure::primal_forms(found, options);
//   const auto c = structure::balanced_coefficients(found, *forms, execution);
//   const auto uv = structure::uv_map(found, *forms, c, execution);  // #corners x 2
//
// The last four lines are structure::balanced_map(part, options, execution). Seamless tilings are tiling::place and
// tiling::tile, those that turn turns::TurnedTiler; islands::island_map cuts at hard edges. uv::quality measures any
// map, and uv::cost says what an eye minds of it. Errors are the exceptions of base/errors.h.
#pragma once

#include "base/errors.h"
#include "base/execution.h"
#include "evening/evening.h"
#include "islands/island_search.h"
#include "mesh/components.h"
#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "mesh/surface.h"
#include "plane/disk_map.h"
#include "plane/rectangle.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"
#include "structure/conformal_structure.h"
#include "structure/options.h"
#include "structure/pole_structure.h"
#include "structure/primal_forms.h"
#include "structure/structure.h"
#include "tiling/tiling.h"
#include "turns/turned_tiling.h"
#include "uv/appearance.h"
#include "uv/distortion.h"
#include "uv/quality.h"
