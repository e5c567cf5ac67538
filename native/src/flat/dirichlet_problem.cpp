#include "flat/dirichlet_problem.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/constants.h"
#include "base/errors.h"
#include "forms/laplacian.h"
#include "linear/dense.h"
#include "mesh/components.h"
#include "mesh/half_edges.h"
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

constexpr double kRounding = 1e-12;  // what |z| may be off on the boundary

// Finds the shift for which the mean of tanh(x + shift) is 0. The mean grows with the shift, so bisection finds it. It
// ends when no number lies between the limits.
double balancing_shift(const Eigen::VectorXd& x, const Eigen::VectorXd& areas) {
  double low = -x.maxCoeff(), high = -x.minCoeff();
  for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
    ((x.array() + middle).tanh().matrix().dot(areas) < 0 ? low : high) = middle;
  return (low + high) / 2;
}

forms::RefinedSolver refined_solver(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                    solver::Laplacian laplacian, int columns, const structure::Options& options,
                                    Execution& execution) {
  const auto choice = solver::choose_method(options.solver, laplacian.size(), columns);
  return {discretisation.half_edges,
          discretisation.weights,
          fixed,
          choice,
          solver::make_solver(choice.method, std::move(laplacian), fixed, execution),
          execution.workers()};
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

Eigen::VectorXcd disk_map(const structure::Structure& s, const uv::UvArray& function, Workers& workers) {
  const Eigen::VectorXcd at_vertex = function.col(0) + std::complex<double>(0, 1) * function.col(1);
  Eigen::VectorXcd z = (std::complex<double>(0, kTwoPi) * at_vertex.array()).exp();
  z[s.stars()[0].vertex] = 0;
  // v >= 0 in the disk, but on coarse meshes the discrete function may be negative inside.
  z = (z.array().abs() > 1 + kRounding).select(z.array() / z.array().abs(), z);
  require_finite(z, "vertex", workers);
  return z;
}

void require_sphere(const structure::Structure& s) {
  if (s.topology.type.closed() && s.topology.type.genus == 0 && s.stars().size() == 2) return;
  throw TopologyError("only a closed surface of genus 0 with two poles has a map to the sphere here");
}

PointArray sphere_map(const structure::Structure& s, const uv::UvArray& function, Workers& workers) {
  // With x = -log |z| = 2 pi v, the height (1 - |z|^2) / (1 + |z|^2) is tanh x, and the distance from the axis 1 / cosh
  // x.
  const Eigen::VectorXcd angle =
      kTwoPi / held(s.poles).chosen.residues[0] * (function.col(0) + std::complex<double>(0, 1) * function.col(1));
  const Eigen::VectorXd turn = angle.real();
  Eigen::VectorXd rise = angle.imag();
  auto areas = mesh::vertex_areas(*s.surface, s.surface->edge_lengths);
  for (const mesh::Star& star : s.stars()) {  // v is infinite at a pole: it takes no part in the mean
    areas[star.vertex] = 0;
    rise[star.vertex] = rise[mesh::from_vertex(*s.surface, mesh::opposite(star.link[0]))];
  }
  rise.array() += balancing_shift(rise, Eigen::Map<const Eigen::VectorXd>(areas.data(), rise.size()));
  PointArray points(rise.size(), 3);
  const Eigen::ArrayXd radius = rise.array().cosh().inverse();
  points << radius * turn.array().cos(), radius * turn.array().sin(), rise.array().tanh();
  points.row(s.stars()[0].vertex) << 0, 0, 1;
  points.row(s.stars()[1].vertex) << 0, 0, -1;
  require_finite(points, "vertex", workers);
  return points;
}

Eigen::VectorXd energies(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                         const Eigen::MatrixXd& functions) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(functions.cols());
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const int head = mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e)),
              tail = mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e + 1));
    result += weights[e] * (functions.row(head) - functions.row(tail)).cwiseAbs2().transpose();
  }
  return result;
}

DirichletProblem::DirichletProblem(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                   int columns, const structure::Options& options, Execution& execution)
    : discretisation_(discretisation),
      fixed_(fixed),
      laplacian_(forms::laplacian(discretisation.half_edges, discretisation.weights, execution)),
      solver_(refined_solver(discretisation, fixed, laplacian_, columns, options, execution)) {}

DirichletSolution DirichletProblem::harmonic(const Eigen::MatrixXd& values, Execution& execution) {
  const auto L = laplacian_.matrix();
  DirichletSolution result;
  // f = values + g, with g = 0 at the fixed vertices and L g = -L values at the free ones.
  result.functions = values + solver_.solve(
                                  -(L * values), solver::Condition::dirichlet,
                                  [&] { return forms::function_terms(discretisation_.half_edges, values); }, execution);
  result.solver = structure::solver_report(solver_);
  for (const int v : fixed_) result.functions.row(v) = values.row(v);  // exactly
  Eigen::MatrixXd flux = L * result.functions;
  const double largest = (L.cwiseAbs() * result.functions.cwiseAbs()).maxCoeff();
  // f . L f cancels where weights are large. Differences first, it does not.
  result.energies = solver_.is_stiff()
                        ? energies(discretisation_.half_edges, discretisation_.weights, result.functions)
                        : Eigen::VectorXd(result.functions.cwiseProduct(flux).colwise().sum().transpose());
  for (const int v : fixed_) flux.row(v).setZero();
  result.harmonicity = flux.cwiseAbs().maxCoeff() / largest;
  return result;
}

Eigen::MatrixXd DirichletProblem::poisson(const Eigen::MatrixXd& sources, Execution& execution) {
  return solver_.solve(
      sources, solver::Condition::dirichlet, [&] { return forms::FluxTerms{.sources = sources}; }, execution);
}

DirichletSolution solve_dirichlet(const mesh::Discretisation& discretisation, const std::vector<int>& fixed,
                                  const Eigen::MatrixXd& values, const structure::Options& options,
                                  Execution& execution) {
  DirichletProblem problem(discretisation, fixed, static_cast<int>(values.cols()), options, execution);
  return problem.harmonic(values, execution);
}

}  // namespace holomorph::flat
