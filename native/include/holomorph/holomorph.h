// Conformal UV maps from holomorphic one-forms: what a C++ program needs. holomorph/openmesh.h takes OpenMesh meshes.
//
//   using namespace holomorph;
//   Execution execution;  // threads and, if you like, a progress function
//   const auto surface = mesh::make_surface(mesh::read("kitten.obj"), execution);
//   const auto part = std::make_shared<mesh::Surface>(mesh::component(surface, 0, execution).surface);
//   const choice::Request request{.part = choice::part_of(part, uv::Up::kY, {}, execution)};
//   const auto map = choice::automatic_map(request, choice::SizePolicy::of_tiles({request.part}, 0), execution);
//   map->uv();  // #corners x 2, of the map that an eye minds least
//
// Or one step after the other:
//
//   const structure::Options options;
//   auto found = structure::conformal_structure(part, options, execution);  // e.g. its period matrix
//   const auto forms = structure::primal_forms(found, options);
//   const auto c = structure::balanced_coefficients(found, *forms, execution);
//   const auto uv = structure::uv_map(found, *forms, c, execution);
//
// Seamless tilings are those of choice::Tiler, those that turn tiling::TurnedTiler's; flat::island_map cuts at hard
// edges. uv::quality measures any map, and uv::cost says what an eye minds of it. Errors are the exceptions of
// base/errors.h.
#pragma once

#include "base/errors.h"
#include "base/execution.h"
#include "choice/automatic_map.h"
#include "choice/quads.h"
#include "flat/dirichlet_problem.h"
#include "flat/island_search.h"
#include "flat/rectangle.h"
#include "mesh/components.h"
#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "mesh/surface.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"
#include "structure/conformal_structure.h"
#include "structure/pole_structure.h"
#include "structure/primal_forms.h"
#include "structure/solver_report.h"
#include "structure/structure.h"
#include "tiling/cones/turned_tiling.h"
#include "tiling/tiling.h"
#include "uv/appearance.h"
#include "uv/evening.h"
#include "uv/quality.h"
