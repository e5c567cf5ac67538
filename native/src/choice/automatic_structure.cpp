#include "choice/automatic_structure.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "choice/any_structure.h"
#include "choice/truncated.h"
#include "flat/dirichlet_problem.h"
#include "flat/rectangle.h"
#include "structure/conformal_structure.h"
#include "structure/pole_structure.h"

namespace holomorph::choice {
namespace {

using structure::Options;

constexpr double kUnevenDisk = 10;  // size range of a disk map, above which others are tried

double density_ratio(AnyStructure& made, Execution& execution) {
  const uv::UvArray uv = made.uv(made.balanced_coefficients(execution), execution);
  return uv::quality(*made.triangulation(), uv, execution.workers()).density_ratio;
}

StructurePointer plane_structure(MapKind kind, const PartPointer& part, flat::PlaneMap map) {
  return std::make_shared<PlaneStructure>(kind, part, std::make_shared<const flat::PlaneMap>(std::move(map)));
}

StructurePointer rectangle(const PartPointer& part, const std::vector<int>& corners, const Options& options,
                           Execution& execution) {
  return plane_structure(MapKind::kRectangle, part,
                         flat::rectangle_map(*part->surface, corners, part->labels, options, execution));
}

std::shared_ptr<structure::Solved> with_poles(const PartPointer& part, const Options& options, Execution& execution) {
  return structure::solved(options, execution, [&](const Options& own, Execution& running) {
    return structure::pole_structure(part->surface, {{}, {}, part->labels}, own, running);
  });
}

// The map of a disk without inner vertices: a rectangle that collapses no triangle, or else the map with a free
// boundary, where it flips none.
StructurePointer without_inner_vertices(const PartPointer& part, const Options& options, Execution& execution) {
  const std::vector<int> quarters = flat::quarter_corners(*part->surface, execution);
  flat::PlaneMap straight = flat::rectangle_map(*part->surface, quarters, part->labels, options, execution);
  const bool is_whole = straight.collapsed_triangles.empty();
  StructurePointer result = plane_structure(MapKind::kRectangle, part, std::move(straight));
  if (is_whole) return result;
  StructurePointer free =
      plane_structure(MapKind::kFlat, part, flat::free_boundary_map(*part->surface, options, execution));
  const uv::Quality quality = free->quality(free->uv({}, execution), execution);
  return std::ranges::count(quality.flipped, 0) < std::ssize(quality.flipped) ? result : free;
}

StructurePointer disk_structure(const PartPointer& part, const Options& options, Execution& execution) {
  const mesh::Surface& surface = *part->surface;
  if (const auto corners = flat::clear_corners(surface, execution))
    return rectangle(part, *corners, options, execution);
  const bool has_four_sides = flat::boundary_length(surface, execution) > 3;
  std::shared_ptr<structure::Solved> solved;
  try {
    solved = with_poles(part, options, execution);
  } catch (const TopologyError&) {  // every vertex is next to the boundary
    if (has_four_sides) return without_inner_vertices(part, options, execution);
    return plane_structure(MapKind::kFlat, part, flat::free_boundary_map(surface, options, execution));
  }
  StructurePointer best = std::make_shared<Forms>(MapKind::kDisk, part, solved);
  double least = density_ratio(*best, execution);
  if (std::sqrt(least) <= kUnevenDisk) return best;
  std::vector<StructurePointer> others{std::make_shared<Forms>(MapKind::kLog, part, solved)};
  if (has_four_sides) others.push_back(rectangle(part, flat::quarter_corners(surface, execution), options, execution));
  for (const StructurePointer& other : others) {
    if (const double ratio = density_ratio(*other, execution); ratio < least) best = other, least = ratio;
  }
  return best;
}

}  // namespace

StructurePointer automatic_structure(const PartPointer& part, const Options& options, Execution& execution) {
  if (part->type.closed() && part->type.genus == 0) {
    try {
      return std::make_shared<Forms>(MapKind::kLog, part, with_poles(part, options, execution));
    } catch (const TopologyError&) {
      if (!part->has_positions()) throw;
      return std::make_shared<Truncated>(part, options, execution);  // the stars of any two vertices meet
    }
  }
  if (part->type.genus == 0 && part->type.boundary_count == 1) return disk_structure(part, options, execution);
  const MapKind kind = part->is_tube() ? MapKind::kStrip : MapKind::kForms;
  return std::make_shared<Forms>(kind, part,
                                 structure::solved(options, execution, [&](const Options& own, Execution& running) {
                                   return structure::conformal_structure(part->surface, own, running);
                                 }));
}

}  // namespace holomorph::choice
