#include "flat/free_boundary.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "base/errors.h"
#include "flat/dirichlet_problem.h"
#include "forms/laplacian.h"
#include "linear/dense.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::IntrinsicTriangulation;

// The half-edges along the boundary, the surface on their left, the first from its lowest vertex.
std::vector<HalfedgeHandle> boundary_of_disk(const mesh::Surface& surface, const HalfEdges& half_edges) {
  const auto type = mesh::topological_type(surface);
  if (type.genus != 0 || type.boundary_count != 1)
    throw TopologyError("the surface has " + type.text() + "; a free boundary needs a disk: cut it open along seams");
  std::vector<HalfedgeHandle> loop = mesh::boundary_loops(surface, half_edges).loops[0];
  std::reverse(loop.begin(), loop.end());
  for (HalfedgeHandle& h : loop) h = mesh::opposite(h);
  return loop;
}

// #V: K, 2 pi less the sum of angles, in the interior; k, pi less that sum, on the boundary. They sum to 2 pi.
Eigen::VectorXd curvatures(const IntrinsicTriangulation& t) {
  const HalfEdges& half_edges = t.half_edges;
  Eigen::VectorXd result(static_cast<Eigen::Index>(half_edges.n_vertices()));
  for (int v = 0; v < result.size(); ++v)
    result[v] = (half_edges.is_boundary(mesh::VertexHandle(v)) ? 1 : 2) * std::numbers::pi;
  for (int i = 0; i < static_cast<int>(t.cotangents.size()); ++i) {
    const HalfedgeHandle h(i);
    if (half_edges.is_boundary(h)) continue;
    result[mesh::to_vertex(half_edges, mesh::next(half_edges, h))] -= std::atan2(1.0, t.cotangents[i]);
  }
  return result;
}

// The closed polygon whose edge j points in the direction of tangents[j] and whose lengths l* are nearest to the given
// ones, in sum (l* - l)^2 / l: its vertices, the first at 0.
std::vector<std::complex<double>> closed_curve(const std::vector<double>& lengths,
                                               const std::vector<std::complex<double>>& tangents) {
  Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gap = Eigen::Vector2d::Zero();
  const auto vector = [&](std::size_t j) { return Eigen::Vector2d(tangents[j].real(), tangents[j].imag()); };
  for (std::size_t j = 0; j < lengths.size(); ++j) {
    M += lengths[j] * vector(j) * vector(j).transpose();
    gap += lengths[j] * vector(j);
  }
  // By Lagrange: l* = l (1 - m . t) with M m = gap, so that sum l* t = gap - M m = 0.
  const Eigen::Vector2d multiplier = linear::solve_symmetric(M, gap);
  std::vector<std::complex<double>> points{0};
  for (std::size_t j = 0; j + 1 < lengths.size(); ++j)
    points.push_back(points.back() + lengths[j] * (1 - multiplier.dot(vector(j))) * tangents[j]);
  return points;
}

// #V x 2: the vertices of the flattened boundary, 0 in the interior. @param turns #V, the exterior angle at each
Eigen::MatrixXd flattened_boundary(const mesh::Discretisation& t, const std::vector<HalfedgeHandle>& loop,
                                   const Eigen::VectorXd& turns) {
  std::vector<double> lengths;
  std::vector<std::complex<double>> tangents;
  double angle = 0;
  for (const HalfedgeHandle h : loop) {
    // The first edge runs along the real axis; every later one has turned at its first vertex.
    if (!lengths.empty()) angle += turns[mesh::from_vertex(t.half_edges, h)];
    lengths.push_back(t.lengths[mesh::edge_of(h)]);  // times e^{(u_i + u_j) / 2} = 1
    tangents.push_back(std::polar(1.0, angle));
  }
  const auto points = closed_curve(lengths, tangents);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(turns.size(), 2);
  for (std::size_t j = 0; j < loop.size(); ++j)
    values.row(mesh::from_vertex(t.half_edges, loop[j])) << points[j].real(), points[j].imag();
  return values;
}

}  // namespace

PlaneMap free_boundary_map(const mesh::Surface& surface, const Options& options, Execution& execution) {
  PlaneMap result;
  execution.stage("half-edges", 0.0, 0.1);
  auto half_edges = mesh::half_edges(surface, execution);
  const auto loop = boundary_of_disk(surface, half_edges);

  execution.stage("intrinsic Delaunay", 0.1, 0.3);
  auto triangulation = mesh::given_triangulation(surface, std::move(half_edges), execution.workers());
  mesh::make_delaunay(triangulation, execution);
  const Eigen::VectorXd K = curvatures(triangulation);
  const auto delaunay = mesh::discretised(std::move(triangulation), execution);
  result.flip_count = static_cast<int>(delaunay.flips.size());
  result.mollification = delaunay.mollification;

  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(surface.vertex_count, 1), z;
  if (static_cast<std::size_t>(surface.vertex_count) == loop.size()) {  // every vertex is on the boundary
    z = flattened_boundary(delaunay, loop, K);
    result.solver.name = "none";
    result.solver.reason = "every vertex lies on the boundary";
  } else {
    execution.stage("scale factors", 0.3, 0.7);
    DirichletProblem problem(delaunay, mesh::boundary_vertices(delaunay.half_edges), 3, options, execution);
    // Under the metric e^(2u) the curvature of a vertex is K + L u: flat means L u = -K.
    u = problem.poisson(-K, execution);
    // Summed flux by flux: at boundary vertices this is -L u with all digits, also for large weights.
    const auto minus_Lu =
        forms::harmonic_residuals(delaunay.half_edges, delaunay.weights, {}, u, execution.workers()).R;
    execution.stage("harmonic extension", 0.7, 1.0);
    auto solved = problem.harmonic(flattened_boundary(delaunay, loop, K - minus_Lu.col(0)), execution);
    z = std::move(solved.functions);
    result.harmonicity = solved.harmonicity;
    result.solver = std::move(solved.solver);
  }
  result.scale_factors = u.col(0).array().exp();
  result.points.resize(surface.vertex_count);
  result.points.real() = z.col(0);
  result.points.imag() = z.col(1);
  require_finite(result.points, "vertex", execution.workers());
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::flat
