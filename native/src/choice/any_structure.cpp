#include "choice/any_structure.h"

#include <algorithm>
#include <complex>
#include <vector>

#include "base/errors.h"
#include "flat/dirichlet_problem.h"
#include "uv/quality.h"

namespace holomorph::choice {
namespace {

uv::UvArray at_corners(const mesh::Surface& surface, const Eigen::VectorXcd& points) {
  const std::vector<int>& vertices = surface.polygons.corner_vertices;
  uv::UvArray result(std::ssize(vertices), 2);
  for (Eigen::Index c = 0; c < result.rows(); ++c) {
    const std::complex<double> z = points(vertices[static_cast<std::size_t>(c)]);
    result.row(c) << z.real(), z.imag();
  }
  return result;
}

// The vertices of the boundary, ascending.
std::vector<int> rim(const mesh::Surface& surface) {
  std::vector<int> result;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) result.insert(result.end(), surface.edges[e].begin(), surface.edges[e].end());
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Those whose number is the least or the largest of all.
std::vector<int> extreme(const std::vector<int>& vertices, const std::vector<double>& values) {
  std::vector<int> result;
  const auto [low, high] = std::ranges::minmax(values);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (values[k] == low || values[k] == high) result.push_back(vertices[k]);
  }
  return result;
}

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

Forms::Forms(MapKind kind, PartPointer part, std::shared_ptr<structure::Solved> solved)
    : AnyStructure(kind, part, kind == MapKind::kDisk ? part->surface : solved->value.surface),
      solved_(std::move(solved)) {}

int Forms::form_count() const {
  return kind() == MapKind::kDisk ? 0 : static_cast<int>(solved_->value.differentials.cols());
}

bool Forms::is_real() const {
  return (kind() == MapKind::kForms || kind() == MapKind::kStrip) && !part()->type.closed();
}

std::vector<int> Forms::seams(Execution&) {
  return kind() == MapKind::kDisk ? std::vector<int>() : solved_->value.topology.seams;
}

std::vector<int> Forms::poles() const {
  const auto& poles = solved_->value.poles;
  return poles ? poles->chosen.vertices : std::vector<int>();
}

void Forms::prepare_uv(Execution& execution) {
  if (kind() == MapKind::kDisk) return;
  solved_->with_forms([&](structure::PrimalForms& forms) { forms.prepare(execution); });
}

Eigen::VectorXcd Forms::balanced_coefficients(Execution& execution) {
  if (kind() == MapKind::kDisk) return {};
  {
    const std::lock_guard lock(mutex_);
    if (balanced_) return *balanced_;
  }
  Eigen::VectorXcd c;
  solved_->with_forms(
      [&](structure::PrimalForms& forms) { c = structure::balanced_coefficients(solved_->value, forms, execution); });
  if (is_real()) c = c.real().eval();
  const std::lock_guard lock(mutex_);
  balanced_ = c;
  return c;
}

uv::UvArray Forms::uv(const Eigen::VectorXcd& coefficients, Execution& execution) {
  const structure::Structure& value = solved_->value;
  uv::UvArray result;
  solved_->with_forms([&](structure::PrimalForms& forms) {
    if (kind() != MapKind::kDisk) {
      result = structure::uv_map(value, forms, coefficients, execution);
    } else {
      const uv::UvArray function = forms.function(value.differentials.col(0), execution);
      result = at_corners(*part()->surface, flat::disk_map(value, function, execution.workers()));
    }
  });
  return result;
}

uv::Kept Forms::kept(const Eigen::VectorXcd& coefficients, Execution&) {
  uv::Kept result;
  switch (kind()) {
    case MapKind::kDisk: {
      result.u = rim(*part()->surface);
      const std::vector<int> centre = poles();
      result.u.insert(result.u.end(), centre.begin(), centre.end());
      std::ranges::sort(result.u);
      result.v = result.u;
      break;
    }
    case MapKind::kLog: {
      result.poles = poles();
      const auto is_real = [](const std::complex<double>& z) { return z.imag() == 0; };
      const auto& residues = held(solved_->value.poles).chosen.residues;
      if (std::ranges::all_of(coefficients, is_real) && std::ranges::all_of(residues, is_real))
        result.v = rim(*triangulation());
      break;
    }
    default:
      if (!part()->type.closed()) result.v = rim(*triangulation());
  }
  return result;
}

PlaneStructure::PlaneStructure(MapKind kind, PartPointer part, std::shared_ptr<const flat::PlaneMap> map,
                               double modulus)
    : AnyStructure(kind, part, part->surface), map_(std::move(map)), modulus_(modulus > 0 ? modulus : map_->modulus) {}

uv::UvArray PlaneStructure::uv(const Eigen::VectorXcd&, Execution&) {
  uv::UvArray result = at_corners(*part()->surface, map_->points);
  if (kind() == MapKind::kRectangle) result.col(1) *= modulus_ / map_->modulus;
  return result;
}

uv::Kept PlaneStructure::kept(const Eigen::VectorXcd&, Execution&) {
  uv::Kept result;
  if (kind() == MapKind::kFlat) return result;
  const std::vector<int> ends = rim(*part()->surface);
  result.u = result.v = ends;
  if (kind() != MapKind::kRectangle) return result;
  std::vector<double> u, v;
  for (const int vertex : ends) {
    u.push_back(map_->points(vertex).real());
    v.push_back(map_->points(vertex).imag());
  }
  result.u = extreme(ends, u);
  result.v = extreme(ends, v);
  return result;
}

uv::Quality AnyStructure::quality(const uv::UvArray& uv, Execution& execution) const {
  uv::Quality result = uv::quality(*triangulation_, uv, execution.workers());
  if (kind_ == MapKind::kFlat) result.overlapping_part = uv::overlapping_part(border(*part_->surface, uv), execution);
  return result;
}

}  // namespace holomorph::choice
