#include "structure/nested_level.h"

#include <utility>

#include "forms/element_forms.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "structure/structure.h"
#include "topology/homology.h"

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

mesh::IntrinsicTriangulation delaunay(const mesh::Surface& surface, Execution& execution) {
  auto triangulation = mesh::given_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
  mesh::make_delaunay(triangulation, execution);
  return triangulation;
}

std::vector<mesh::FaceWeights> face_weights(const mesh::IntrinsicTriangulation& triangulation) {
  std::vector<mesh::FaceWeights> weights;
  for (int t = 0; t < static_cast<int>(triangulation.half_edges.n_faces()); ++t) {
    weights.push_back(
        mesh::face_weights(triangulation.metric(), triangulation.half_edges.halfedge_handle(mesh::FaceHandle(t))));
  }
  return weights;
}

IntegerForms classes_on_delaunay(const mesh::Surface& surface, const SideClasses& sides,
                                 const std::vector<mesh::Flip>& flips) {
  auto classes = edge_classes(surface, sides, static_cast<int>(sides.cols() / 3));
  topology::pull_back(flips, classes);
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

std::vector<double> length_errors(const mesh::Surface& surface) {
  Execution silent;
  const auto given = mesh::given_triangulation(surface, mesh::half_edges(surface, silent), silent.workers());
  std::vector<double> errors;
  for (const mesh::FaceError& error : given.metric_errors) errors.push_back(error.largest);
  return errors;
}

NestedLevel solve_level(const mesh::Surface& surface, const SideClasses& sides, int natural, int order,
                        Execution& execution) {
  NestedLevel level;
  execution.stage("refined triangulation", 0.0, 0.2);
  const auto triangulation = delaunay(surface, execution);
  level.mollification = triangulation.mollification;
  // 1 stands for unknown: there are no errors if a triangle was mollified.
  level.errors.assign(surface.triangles.size(), 1);
  if (triangulation.metric_errors.empty()) return level;
  for (std::size_t t = 0; t < level.errors.size(); ++t) level.errors[t] = triangulation.metric_errors[t].largest;
  level.lengths.assign(triangulation.lengths.begin(), triangulation.lengths.end());
  const auto classes = classes_on_delaunay(surface, sides, triangulation.flips);
  write_triangulation(triangulation.half_edges, classes, level);

  const forms::ElementForms forms(triangulation.half_edges, face_weights(triangulation), classes, natural, order);
  execution.stage("refined forms", 0.2, 0.8);
  level.functions = forms.solve(execution);
  execution.stage("refined bounds", 0.8, 1.0);
  execution.part(0, 0.5);
  level.energies = certain_energies(forms.gram_matrices(level.functions, execution));
  execution.part(0.5, 1);
  level.gaps = forms.gaps(level.functions, level.energies.gram, execution);
  execution.finish();
  return level;
}

CertainGram measure_level(const mesh::Surface& surface, const SideClasses& sides, int natural, int order,
                          const forms::RowMajorMatrix& functions, Execution& execution) {
  const auto triangulation = delaunay(surface, execution);
  const auto classes = classes_on_delaunay(surface, sides, triangulation.flips);
  const forms::ElementForms forms(triangulation.half_edges, face_weights(triangulation), classes, natural, order);
  return certain_energies(forms.gram_matrices(functions, execution));
}

CertainGram measure(const mesh::Surface& surface, const SideClasses& sides, int natural,
                    const forms::RowMajorMatrix& functions, Execution& execution) {
  const auto delaunay = mesh::on_delaunay(surface, mesh::half_edges(surface, execution), execution);
  return energies(delaunay, classes_on_delaunay(surface, sides, delaunay.flips), natural, functions, execution);
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
