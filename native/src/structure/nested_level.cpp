#include "structure/nested_level.h"

#include <algorithm>
#include <utility>

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

// The Delaunay triangulation of a surface with all that energies on it are made of.
struct Triangulated {
  mesh::IntrinsicTriangulation triangulation;
  std::vector<int> fixed;
  Array<double> weights, errors;
  IntegerForms classes;

  Triangulated(const mesh::Surface& surface, const SideClasses& sides, Execution& execution)
      : triangulation(mesh::given_triangulation(surface, mesh::half_edges(surface, execution), execution.workers())),
        fixed(mesh::boundary_vertices(triangulation.half_edges)),
        classes(edge_classes(surface, sides, static_cast<int>(sides.cols() / 3))) {
    mesh::make_delaunay(triangulation, execution);
    weights = mesh::cotangent_weights(triangulation, execution);
    errors = mesh::energy_errors(triangulation.metric(), weights, execution.workers());
    topology::pull_back(triangulation.flips, classes);
  }

  CertainGram measure(const forms::RowMajorMatrix& functions, int natural, Execution& execution) const {
    const int dirichlet = classes.form_count - natural;
    forms::ClosedForms forms{classes, functions};
    forms.functions(fixed, Eigen::lastN(dirichlet)).setZero();
    std::vector<int> families{natural};
    if (dirichlet > 0) families.push_back(dirichlet);
    return certain_energies(triangulation.half_edges, weights, errors, forms, families, execution);
  }
};

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
  const Triangulated t(surface, sides, execution);
  level.mollification = t.triangulation.mollification;
  write_triangulation(t.triangulation, t.classes, level);

  execution.stage("refined forms", 0.3, 0.9);
  const auto plan = plan_memory({surface.vertex_count, static_cast<std::int64_t>(surface.edges.size()), count},
                                options.solver, options.memory_limit, Keeping::all);
  execution.part(0, 0.5);
  HarmonicSystems systems(t.triangulation.half_edges, t.weights, t.fixed, plan.choice, execution);
  execution.part(0.5, 1);
  level.functions = systems.solve(t.classes, natural, plan.block, execution).functions;

  execution.stage("refined bounds", 0.9, 1.0);
  level.energies = t.measure(level.functions, natural, execution);
  execution.finish();
  return level;
}

CertainGram measure(const mesh::Surface& surface, const SideClasses& sides, int natural,
                    const forms::RowMajorMatrix& functions, Execution& execution) {
  return Triangulated(surface, sides, execution).measure(functions, natural, execution);
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
