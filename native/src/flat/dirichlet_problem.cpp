#include "flat/dirichlet_problem.h"

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/held.h"
#include "forms/laplacian.h"
#include "mesh/half_edges.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

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

Eigen::VectorXcd disk_map(const structure::Structure& s, const uv::UvArray& function, Workers& workers) {
  const Eigen::VectorXcd at_vertex = function.col(0) + std::complex<double>(0, 1) * function.col(1);
  Eigen::VectorXcd z = (std::complex<double>(0, 2 * std::numbers::pi) * at_vertex.array()).exp();
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
  const Eigen::VectorXcd angle = 2 * std::numbers::pi / held(s.poles).chosen.residues[0] *
                                 (function.col(0) + std::complex<double>(0, 1) * function.col(1));
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
