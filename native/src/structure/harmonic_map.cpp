#include "structure/harmonic_map.h"

#include <cmath>
#include <span>
#include <string>

#include "base/errors.h"
#include "forms/closed_forms.h"
#include "forms/refined_solver.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"

namespace holomorph::structure {
namespace {

// The two sides of an edge may differ by this fraction of the largest coordinate: UVs are often kept in single
// precision, which rounds each coordinate by 6e-8 of itself.
constexpr double kSameVector = 1e-6;

void check_topology(const mesh::Surface& surface) {
  const auto type = mesh::topological_type(surface);
  if (surface.component_count == 1 && type.form_count() > 0) return;
  const std::string found =
      surface.component_count == 1 ? type.text() : std::to_string(surface.component_count) + " components";
  throw TopologyError("the surface has " + found +
                      "; a harmonic map of the same periods needs one surface with handles or two boundaries");
}

// The columns of v must not change along the boundary.
void check_boundary(const mesh::Surface& surface, const forms::RowMajorMatrix& edge_values, double tolerance) {
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] > 1) continue;
    for (Eigen::Index k = 1; k < edge_values.cols(); k += 2) {
      if (std::abs(edge_values(static_cast<Eigen::Index>(e), k)) <= tolerance) continue;
      throw InvalidMesh("v changes along the boundary edge between vertices " + std::to_string(surface.edges[e][0]) +
                        " and " + std::to_string(surface.edges[e][1]) +
                        " of the level; only maps with straight boundaries, along which v is constant, have a "
                        "harmonic one of the same periods");
    }
  }
}

// #V x 2m the values at the first corner of each vertex.
forms::RowMajorMatrix first_values(const mesh::Surface& surface, const forms::RowMajorMatrix& values) {
  forms::RowMajorMatrix first(surface.vertex_count, values.cols());
  const auto& corner_vertices = surface.polygons.corner_vertices;
  for (std::size_t c = corner_vertices.size(); c-- > 0;)
    first.row(corner_vertices[c]) = values.row(static_cast<Eigen::Index>(c));
  return first;
}

// #E x 2m the differences of the corner values along half-edges 2e, the same in both triangles of an edge.
forms::RowMajorMatrix differences(const mesh::Surface& surface, const forms::RowMajorMatrix& values, double tolerance) {
  forms::RowMajorMatrix edge_values(static_cast<Eigen::Index>(surface.edges.size()), values.cols());
  std::vector<char> seen(surface.edges.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int e = surface.triangle_edges[t][i], from = surface.triangle_corners[t][i],
                to = surface.triangle_corners[t][(i + 1) % 3];
      const double sign = surface.edges[e][0] == surface.triangles[t][i] ? 1 : -1;
      const Eigen::RowVectorXd along = sign * (values.row(to) - values.row(from));
      if (!seen[e]) {
        edge_values.row(e) = along;
        seen[e] = 1;
      } else if ((edge_values.row(e) - along).cwiseAbs().maxCoeff() > tolerance) {
        throw InvalidMesh("across the edge between vertices " + std::to_string(surface.edges[e][0]) + " and " +
                          std::to_string(surface.edges[e][1]) +
                          " of the level the UV map is rotated or scaled; only a map that is translated across its "
                          "seams has a harmonic one of the same periods");
      }
    }
  }
  return edge_values;
}

// The natural condition for all columns; with a boundary the columns of v, the odd ones, are fixed there.
std::vector<solver::Condition> conditions_of(Eigen::Index columns, bool bounded) {
  std::vector<solver::Condition> conditions(columns, solver::Condition::natural);
  for (Eigen::Index v = 1; bounded && v < columns; v += 2) conditions[v] = solver::Condition::dirichlet;
  return conditions;
}

forms::FluxTerms terms_of(const forms::RowMajorMatrix& edge_values) {
  return {[&edge_values](mesh::HalfedgeHandle h, Eigen::VectorXd& values) {
    values += mesh::sign(h) * edge_values.row(mesh::edge_of(h)).transpose();
  }};
}

}  // namespace

HarmonicMap harmonic_map(const mesh::Surface& surface, const forms::RowMajorMatrix& corner_values,
                         const structure::Options& options, Execution& execution) {
  execution.stage("level of detail", 0.0, 0.2);
  check_topology(surface);
  auto half_edges = mesh::half_edges(surface, execution);
  const auto fixed = mesh::boundary_vertices(half_edges);
  const double tolerance = kSameVector * corner_values.cwiseAbs().maxCoeff();
  forms::RowMajorMatrix edge_values = differences(surface, corner_values, tolerance);
  check_boundary(surface, edge_values, tolerance);
  // The map is a function of the vertices and a form that is 0 away from the seams. Starting from that form, the
  // right-hand sides are large even if the map is harmonic already, and residuals relative to them mean something.
  // The values of v at the boundary stay part of the form: the function is 0 there.
  forms::RowMajorMatrix start = first_values(surface, corner_values);
  for (const int v : fixed) start(v, Eigen::seq(1, Eigen::last, 2)).setZero();
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    edge_values.row(static_cast<Eigen::Index>(e)) -= start.row(surface.edges[e][1]) - start.row(surface.edges[e][0]);
  }
  const auto input = mesh::on_input(surface, std::move(half_edges), execution);

  execution.stage("harmonic map of the level", 0.2, 1.0);
  const auto choice = solver::choose_method(options.solver, surface.vertex_count, edge_values.cols());
  forms::RefinedSolver solver(input.half_edges, input.weights, fixed, choice, execution);
  HarmonicMap result;
  result.moves =
      solver.solve(
          forms::codifferentials(surface, input.weights, edge_values, execution.workers()),
          conditions_of(edge_values.cols(), !fixed.empty()), [&] { return terms_of(edge_values); }, execution) -
      start;
  const auto weights_of_mean = mesh::vertex_areas(surface, input.lengths);
  const Eigen::Map<const Eigen::VectorXd> areas(weights_of_mean.data(), surface.vertex_count);
  // With boundary, v is fixed there, and u alone is free up to a constant.
  Eigen::RowVectorXd mean = areas.transpose() * result.moves / areas.sum();
  if (!fixed.empty()) mean(Eigen::seq(1, Eigen::last, 2)).setZero();
  result.moves.rowwise() -= mean;
  result.solver = structure::solver_report(solver);
  execution.finish();
  return result;
}

}  // namespace holomorph::structure
