#include "structure/nested_level.h"

#include <utility>

#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "structure/structure.h"
#include "topology/integer_forms.h"

namespace holomorph::structure {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

IntegerForms edge_classes(const mesh::Surface& surface, const SideClasses& sides, int count) {
  IntegerForms forms;
  forms.form_count = count;
  forms.rows.resize(surface.edges.size());
  const mesh::Sides half_edge(surface);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const HalfedgeHandle h = half_edge(t, i);
      const auto values = sides.row(t).segment(static_cast<Eigen::Index>(i) * count, count);
      // The triangle on the other side writes this edge, along its direction. A boundary edge has one triangle alone.
      if (mesh::sign(h) < 0 && surface.edge_face_count[edge_of(h)] == 2) continue;
      IntegerForms::Row row;
      for (int j = 0; j < count; ++j) {
        if (values[j] != 0) row.emplace_back(j, mesh::sign(h) * values[j]);
      }
      forms.rows.set(edge_of(h), std::move(row));
    }
  }
  return forms;
}

void write_side(const IntegerForms& forms, HalfedgeHandle h, int t, int i, SideClasses& sides) {
  for (const auto& [form, value] : forms.rows[edge_of(h)])
    sides(t, static_cast<Eigen::Index>(i) * forms.form_count + form) = mesh::sign(h) * value;
}

void write_triangulation(const mesh::HalfEdges& half_edges, const IntegerForms& classes, NestedLevel& level) {
  const auto count = static_cast<int>(half_edges.n_faces());
  level.triangles.resize(count);
  level.triangle_edges.resize(count);
  level.classes = SideClasses::Zero(count, 3 * static_cast<Eigen::Index>(classes.form_count));
  for (int t = 0; t < count; ++t) {
    HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(t));
    for (int i = 0; i < 3; ++i, h = mesh::next(half_edges, h)) {
      level.triangles[t][i] = mesh::from_vertex(half_edges, h);
      level.triangle_edges[t][i] = edge_of(h);
      write_side(classes, h, t, i, level.classes);
    }
  }
}

IntegerForms classes_on_delaunay(const mesh::Surface& surface, const SideClasses& sides,
                                 const mesh::Discretisation& delaunay) {
  auto classes = edge_classes(surface, sides, static_cast<int>(sides.cols() / 3));
  topology::pull_back(delaunay.flips, classes);
  return classes;
}

CertainGram energies(const mesh::Discretisation& delaunay, const IntegerForms& classes, int natural,
                     forms::RowMajorMatrix functions, Execution& execution) {
  const int dirichlet = classes.form_count - natural;
  // Exactly 0 on the boundary, whatever the solver left: only such a function is admissible, and its energy a bound.
  functions(mesh::boundary_vertices(delaunay.half_edges), Eigen::lastN(dirichlet)).setZero();
  std::vector<int> families{natural};
  if (dirichlet > 0) families.push_back(dirichlet);
  return certain_energies(delaunay, {classes, functions}, families, execution);
}

}  // namespace

SideClasses side_classes(const Structure& s) {
  const mesh::Surface& surface = *s.surface;
  Execution silent;
  const auto half_edges = mesh::half_edges(surface, silent);
  const auto classes = classes_on(s.topology, half_edges, {});
  const auto count = static_cast<Eigen::Index>(surface.triangles.size());
  SideClasses sides = SideClasses::Zero(count, 3 * static_cast<Eigen::Index>(classes.form_count));
  const mesh::Sides half_edge(surface);
  for (int t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) write_side(classes, half_edge(t, i), t, i, sides);
  }
  return sides;
}

NestedLevel solve_level(const mesh::Surface& surface, const SideClasses& sides, int natural, const Options& options,
                        Execution& execution) {
  NestedLevel level;
  execution.stage("refined triangulation", 0.0, 0.3);
  auto triangulation = mesh::given_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
  // Refinement cuts Delaunay triangles, whose children are not all Delaunay. Flips only lower the energies, so that the
  // bounds stay nested.
  mesh::make_delaunay(triangulation, execution);
  // 1 stands for unknown: there are no errors if a triangle was mollified.
  level.errors.assign(surface.triangles.size(), 1);
  for (std::size_t t = 0; t < triangulation.metric_errors.size(); ++t)
    level.errors[t] = triangulation.metric_errors[t].largest;
  const auto delaunay = mesh::discretised(std::move(triangulation), execution);
  level.lengths.assign(delaunay.lengths.begin(), delaunay.lengths.end());
  level.mollification = delaunay.mollification;
  const auto classes = classes_on_delaunay(surface, sides, delaunay);
  write_triangulation(delaunay.half_edges, classes, level);

  execution.stage("refined forms", 0.3, 0.9);
  execution.part(0, 0.5);
  HarmonicSolver solver(delaunay, classes.form_count, options, execution);
  execution.part(0.5, 1);
  level.functions = solver.solve(classes, natural, execution);

  execution.stage("refined bounds", 0.9, 1.0);
  level.energies = energies(delaunay, classes, natural, level.functions, execution);
  execution.finish();
  return level;
}

CertainGram measure(const mesh::Surface& surface, const SideClasses& sides, int natural,
                    const forms::RowMajorMatrix& functions, Execution& execution) {
  const auto delaunay = mesh::on_delaunay(surface, mesh::half_edges(surface, execution), execution);
  return energies(delaunay, classes_on_delaunay(surface, sides, delaunay), natural, functions, execution);
}

Structure narrowed(Structure structure, CertainGram energies, double metric) {
  auto& harmonic = structure.harmonic;
  Execution execution(1);
  harmonic.invariants = invariants(structure.topology, std::move(energies), execution);
  harmonic.certificate.metric = metric;
  // The differentials follow from the period matrix, which the finer energies have changed.
  structure.differentials = structure.holomorphic().differentials;
  require_guaranteed(structure);
  return structure;
}

}  // namespace holomorph::structure
