#include "structure/nested_level.h"

#include <algorithm>
#include <utility>

#include "forms/gram_matrices.h"
#include "mesh/boundary_loops.h"
#include "mesh/delaunay.h"
#include "mesh/metric_errors.h"
#include "structure/guarantee.h"
#include "structure/harmonic_systems.h"
#include "structure/invariants.h"
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

void write_triangulation(const mesh::IntrinsicTriangulation& triangulation, const IntegerForms& classes,
                         NestedLevel& level) {
  const mesh::HalfEdges& mesh = triangulation.half_edges;
  const auto count = static_cast<int>(mesh.n_faces());
  level.triangles.resize(count);
  level.triangle_edges.resize(count);
  level.errors.assign(count, 1);
  level.classes = SideClasses::Zero(count, 3 * static_cast<Eigen::Index>(classes.form_count));
  level.lengths.assign(triangulation.lengths.begin(), triangulation.lengths.end());
  for (int t = 0; t < count; ++t) {
    HalfedgeHandle h = mesh.halfedge_handle(mesh::FaceHandle(t));
    for (int i = 0; i < 3; ++i, h = mesh::next(mesh, h)) {
      level.triangles[t][i] = mesh::from_vertex(mesh, h);
      level.triangle_edges[t][i] = edge_of(h);
      write_side(classes, h, t, i, level.classes);
    }
    if (!triangulation.metric_errors.empty()) level.errors[t] = triangulation.metric_errors[t].largest;
  }
}

}  // namespace

SideClasses side_classes(const Structure& s) {
  const mesh::Surface& surface = *s.surface;
  Execution silent;
  const auto half_edges = mesh::half_edges(surface, silent);
  const int natural = s.topology.families.natural;
  const auto classes =
      harmonic_classes(s.topology, half_edges, topology::first_forms(s.topology.classes, natural, natural));
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
  const int count = static_cast<int>(sides.cols() / 3);
  NestedLevel level;
  execution.stage("refined triangulation", 0.0, 0.3);
  auto triangulation = mesh::given_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
  const std::vector<int> fixed = mesh::boundary_vertices(triangulation.half_edges);
  mesh::make_delaunay(triangulation, execution);
  level.mollification = triangulation.mollification;
  const auto weights = mesh::cotangent_weights(triangulation, execution);
  const auto errors = mesh::energy_errors(triangulation.metric(), weights, execution.workers());
  auto classes = edge_classes(surface, sides, count);
  topology::pull_back(triangulation.flips, classes);
  write_triangulation(triangulation, classes, level);

  execution.stage("refined forms", 0.3, 0.9);
  const auto plan = plan_memory({surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), count},
                                options.solver, options.memory_limit, Keeping::all);
  execution.part(0, 0.5);
  HarmonicSystems systems(triangulation.half_edges, weights, fixed, plan.choice, execution);
  execution.part(0.5, 1);
  forms::ClosedForms forms{classes, systems.solve(classes, natural, plan.block, execution).functions};
  forms.functions(fixed, Eigen::lastN(count - natural)).setZero();

  execution.stage("refined bounds", 0.9, 1.0);
  std::vector<int> families{natural};
  if (count > natural) families.push_back(count - natural);
  std::vector<Eigen::MatrixXd> uncertain;
  for (const auto& gram : forms::gram_matrices(triangulation.half_edges, weights, errors, forms, families, execution)) {
    level.gram.push_back(gram.value);
    if (!errors.empty()) uncertain.push_back(forms::gram_errors(gram));
  }
  level.certain_gram = certain_gram(level.gram, uncertain);
  level.functions.swap(forms.functions);
  execution.finish();
  return level;
}

void narrow(Structure& structure, std::vector<Eigen::MatrixXd> gram, std::vector<Eigen::MatrixXd> certain_gram,
            double metric) {
  structure.gram = std::move(gram);
  structure.certain_gram = std::move(certain_gram);
  structure.certificate.metric = metric;
  set_holomorphic_basis(structure);
  require_guaranteed(structure);
}

}  // namespace holomorph::structure
