#include "choice/any_structure.h"

#include <complex>
#include <vector>

#include "uv/quality.h"

namespace holomorph::choice {
namespace {

// The edges of polygons that no other polygon has, as curves in the plane.
std::vector<uv::Ends> border(const mesh::Surface& surface, const uv::UvArray& uv) {
  std::vector<uv::Ends> result;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int side = 0; side < 3; ++side) {
      if (surface.edge_face_count[surface.triangle_edges[t][side]] != 1) continue;
      const int a = surface.triangle_corners[t][side], b = surface.triangle_corners[t][(side + 1) % 3];
      result.push_back({std::complex(uv(a, 0), uv(a, 1)), std::complex(uv(b, 0), uv(b, 1))});
    }
  }
  return result;
}

}  // namespace

uv::Quality AnyStructure::quality(const uv::UvArray& uv, Execution& execution) const {
  uv::Quality result = uv::quality(*triangulation_, uv, execution.workers());
  if (kind_ == MapKind::kFlat) result.overlapping_part = uv::overlapping_part(border(*part_->surface, uv), execution);
  return result;
}

}  // namespace holomorph::choice
