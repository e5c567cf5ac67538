// Conformal structures, and the systems behind them.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "flat/dirichlet_problem.h"
#include "forms/certain_bounds.h"
#include "structure/conformal_structure.h"
#include "structure/harmonic_solver.h"
#include "structure/nested_level.h"
#include "structure/paper_forms.h"
#include "structure/pole_structure.h"
#include "structure/primal_forms.h"
#include "structure/solver_report.h"
#include "topology/fundamental_domain.h"

namespace holomorph::bindings {
namespace {

using structure::Options;
using SurfacePointer = std::shared_ptr<mesh::Surface>;
using Problem = structure::LaplaceProblem;

std::shared_ptr<Problem> laplace_problem(const mesh::Surface& surface, const std::vector<int>& fixed,
                                         const std::string& solver, int threads) {
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return std::make_shared<Problem>(structure::laplace_problem(surface, fixed, {solver}, execution));
}

// @param dirichlet one flag per column of B
py::array solve(Problem& problem, const Eigen::MatrixXd& B, const std::vector<bool>& dirichlet) {
  solver::Solution X;
  {
    const py::gil_scoped_release unlocked;
    std::vector<solver::Condition> conditions;
    for (const bool zero : dirichlet) {
      conditions.push_back(zero ? solver::Condition::dirichlet : solver::Condition::natural);
    }
    Execution execution(problem.threads);
    X = problem.solver->solve(B, conditions, execution);
  }
  return give_matrix(std::move(X));
}

structure::SolverReport report(const Problem& problem) {
  const auto& solver = *problem.solver;
  return {solver.name(), solver.remark(), solver.iterations(), solver.residual()};
}

Eigen::MatrixX2i ends(const Problem& problem) {
  const auto& all = problem.ends;
  return Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>>(all.front().data(), all.size(), 2);
}

void bind_laplace_problem(py::module_& m) {
  py::class_<Problem, std::shared_ptr<Problem>>(m, "LaplaceProblem")
      .def(py::init(&laplace_problem), py::arg("surface"), py::arg("fixed"), py::arg("solver"), py::arg("threads"))
      .def("solve", &solve, py::arg("right_hand_sides"), py::arg("dirichlet"))
      .def("report", &report)
      .def("edges", [](const Problem& p) { return copy(ends(p)); })
      .def("weights", [](const Problem& p) { return copy(p.weights); });
}

std::vector<py::array> loops_of_vertices(const mesh::EdgeEnds& ends,
                                         const std::vector<std::vector<mesh::HalfedgeHandle>>& loops) {
  std::vector<py::array> result;
  for (const auto& loop : loops) {
    std::vector<int> vertices;
    for (const auto h : loop) vertices.push_back(mesh::from_vertex(ends, h));
    result.push_back(copy(vertices));
  }
  return result;
}

// (#forms, #E) values of the natural classes along half-edge 2e.
py::array integer_classes(const Structure& s) {
  const structure::Topology& topology = s.value.topology;
  const int count = topology.families.natural;
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values =
      decltype(values)::Zero(count, static_cast<Eigen::Index>(s.value.surface->edges.size()));
  for (const int e : topology.classes.rows.edges()) {
    for (const auto& [form, value] : topology::forms_between(topology.classes.rows[e], 0, count))
      values(form, e) = value;
  }
  return give_matrix(std::move(values));
}

// The fundamental domain, recomputed on demand; deterministic.
struct DomainArrays {
  Array<int> faces;
  std::vector<int> joined, boundary, tree, left_over;  // half-edges of the boundary; edges of the others
};

DomainArrays domain_arrays(const Structure& s) {
  Execution execution(s.threads);
  const mesh::HalfEdges half_edges = mesh::half_edges(*s.value.surface, execution);
  auto domain = topology::fundamental_domain(*s.value.surface, half_edges, execution);
  DomainArrays result;
  for (const int f : domain.face_order) {
    const mesh::HalfedgeHandle h = domain.to_parent_face[f];
    result.joined.push_back(h.is_valid() ? mesh::edge_of(h) : -1);
  }
  for (const auto h : topology::domain_boundary(half_edges, domain)) result.boundary.push_back(h.idx());
  result.tree.resize(domain.vertex_rank.size());
  for (std::size_t v = 0; v < result.tree.size(); ++v) {
    const mesh::HalfedgeHandle h = domain.to_parent_vertex[v];
    result.tree[domain.vertex_rank[v]] = h.is_valid() ? mesh::edge_of(h) : -1;
  }
  result.tree.erase(result.tree.begin());  // the root, the only one without a parent
  result.faces = std::move(domain.face_order);
  result.left_over = std::move(domain.left_over);
  return result;
}

// (faces, edges across which they were joined, half-edges of the boundary, edges of the tree, edges left over)
std::array<py::array, 5> fundamental_domain(const Structure& s) {
  DomainArrays found;
  {
    const py::gil_scoped_release unlocked;
    found = domain_arrays(s);
  }
  return {give(std::move(found.faces)), give(std::move(found.joined)), give(std::move(found.boundary)),
          give(std::move(found.tree)), give(std::move(found.left_over))};
}

void bind_topology(py::class_<Structure, StructurePointer>& type) {
  type.def("homology_basis",
           [](const Structure& s) { return loops_of_vertices(*s.value.surface, s.value.topology.homology_basis); })
      .def("boundary_loops",
           [](const Structure& s) { return loops_of_vertices(*s.value.surface, s.value.topology.boundary.loops); })
      .def("pairing", [](const Structure& s) { return copy(s.value.topology.pairing); })
      .def("intersection_matrix", [](const Structure& s) { return copy(s.value.topology.canonical.intersection); })
      .def("canonical_basis", [](const Structure& s) { return copy(s.value.topology.canonical.cycles); })
      .def("seams", [](const Structure& s) { return copy(s.value.topology.seams); })
      .def("integer_classes", &integer_classes)
      .def("fundamental_domain", &fundamental_domain);
}

std::vector<py::array> matrices(const std::vector<Eigen::MatrixXd>& list) {
  std::vector<py::array> result;
  for (const auto& matrix : list) result.push_back(copy(matrix));
  return result;
}

void bind_invariants(py::class_<Structure, StructurePointer>& type) {
  type.def("gram_matrices", [](const Structure& s) { return matrices(s.value.harmonic.invariants.energies.gram); })
      .def("certain_gram_matrices",
           [](const Structure& s) { return matrices(s.value.harmonic.invariants.energies.certain); })
      .def("natural_gram", [](const Structure& s) { return copy(s.value.holomorphic().star.natural_gram); })
      .def("dirichlet_gram", [](const Structure& s) { return copy(s.value.holomorphic().star.dirichlet_gram); })
      .def("star", [](const Structure& s) { return copy(s.value.holomorphic().star.star); })
      .def("period_matrix", [](const Structure& s) { return copy(s.value.holomorphic().period_matrix); })
      .def("period_bounds",
           [](const Structure& s) {
             const auto& bounds = s.value.holomorphic().bounds;
             return py::make_tuple(copy(bounds.lower), copy(bounds.upper));
           })
      .def("real_period_bounds",
           [](const Structure& s) {
             const auto& bounds = s.value.holomorphic().bounds;
             return py::make_tuple(copy(bounds.real_lower), copy(bounds.real_upper));
           })
      .def("inverse_gram_bounds",
           [](const Structure& s) {
             std::vector<Eigen::MatrixXd> below;
             for (const auto& gram : s.value.harmonic.invariants.energies.certain)
               below.push_back(forms::below_inverse(gram));
             return matrices(below);
           })
      .def("residuals",
           [](const Structure& s) {
             const auto& [residuals, periods, pairing, asymmetry, metric] = s.value.harmonic.certificate;
             return Residuals{residuals.closedness, residuals.harmonicity, periods, pairing, asymmetry};
           })
      .def("side_classes", [](const Structure& s) { return copy(structure::side_classes(s.value)); })
      .def(
          "narrow",
          [](Structure& s, std::vector<Eigen::MatrixXd> gram, std::vector<Eigen::MatrixXd> certain, double metric) {
            // On a copy: where these energies are refused, the structure stays as it was.
            s.value = structure::narrowed(s.value, {std::move(gram), std::move(certain)}, metric);
          },
          py::arg("gram"), py::arg("certain"), py::arg("metric_error"))
      .def("flip_count", [](const Structure& s) { return s.value.record.flip_count; })
      .def("mollification", [](const Structure& s) { return s.value.record.mollification; })
      .def("metric_error", [](const Structure& s) { return s.value.harmonic.certificate.metric; });
}

// Runs `compute(options, execution)` without the interpreter's lock.
template <class Compute>
StructurePointer make(const Options& options, int threads, const py::object& progress_function,
                      const Compute& compute) {
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  const StructurePointer made = structure::solved(options, execution, compute);
  made->threads = threads;
  return made;
}

StructurePointer conformal(const SurfacePointer& surface, bool over_double, const std::string& solver, int threads,
                           std::int64_t memory_limit, const py::object& progress) {
  const auto boundary = over_double ? structure::Boundary::double_cover : structure::Boundary::natural;
  return make({solver, memory_limit, boundary}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::conformal_structure(surface, options, execution);
  });
}

StructurePointer with_poles(const SurfacePointer& surface, const std::vector<int>& vertices,
                            const std::vector<std::complex<double>>& residues, const std::vector<int>& labels,
                            const std::string& solver, int threads, std::int64_t memory_limit,
                            const py::object& progress) {
  return make({solver, memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::pole_structure(surface, {vertices, residues, labels}, options, execution);
  });
}

using Thresholds = std::optional<std::vector<std::int64_t>>;

StructurePointer paper(const SurfacePointer& surface, const Thresholds& thresholds, int threads,
                       std::int64_t memory_limit, const py::object& progress) {
  return make({"auto", memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::paper_structure(surface, options, execution, {thresholds});
  });
}

// The structure of a level of a progressive mesh, in the classes of its base; `surface` is the surface of that level.
StructurePointer conformal_of_level(const progressive::ProgressiveMesh& mesh, int splits, const SurfacePointer& surface,
                                    const std::string& solver, int threads, std::int64_t memory_limit,
                                    const py::object& progress) {
  return make({solver, memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::conformal_structure(surface, options, execution, topology::lifted_bases(mesh, splits, *surface));
  });
}

StructurePointer paper_of_level(const progressive::ProgressiveMesh& mesh, int splits, const SurfacePointer& surface,
                                const Thresholds& thresholds, int threads, std::int64_t memory_limit,
                                const py::object& progress) {
  return make({"auto", memory_limit}, threads, progress, [&](const Options& options, Execution& execution) {
    return structure::paper_structure(surface, options, execution, {thresholds},
                                      structure::paper_levels(mesh, splits, *surface));
  });
}

void prepare_uv(Structure& s, const py::object& progress) {
  with_forms(
      s, [](auto& forms, Execution& execution) { forms.prepare(execution); }, callback(progress));
}

structure::SolverReport uv_solver(Structure& s) {
  structure::SolverReport found;
  with_forms(s, [&](auto& forms, Execution& execution) {
    forms.prepare(execution);
    found = forms.solver();
  });
  return found;
}

// UVs of sum_k p_k h_k, #C x 2.
py::array uv(Structure& s, const Eigen::VectorXcd& p) {
  // NumPy takes large arrays on large pages.
  py::array_t<double> result(
      {static_cast<py::ssize_t>(s.value.surface->polygons.corner_vertices.size()), py::ssize_t{2}});
  Eigen::Map<uv::UvArray> corners(result.mutable_data(), result.shape(0), 2);
  with_forms(s, [&](auto& forms, Execution& execution) {
    structure::write_uv_map(s.value, forms.function(p, execution), p, corners, execution.workers());
  });
  return read_only(std::move(result));
}

// Values of all forms of the basis on the edges, #forms x #E.
py::array basis_forms(Structure& s) {
  py::array_t<double> values({static_cast<py::ssize_t>(s.value.topology.families.count()),
                              static_cast<py::ssize_t>(s.value.surface->edges.size())});
  Eigen::Map<forms::RowMajorMatrix> rows(values.mutable_data(), values.shape(0), values.shape(1));
  with_forms(s, [&](auto& forms, Execution& execution) { forms.write_edge_values(rows, execution); });
  return read_only(std::move(values));
}

Eigen::VectorXcd balanced_coefficients(Structure& s, const py::object& progress) {
  Eigen::VectorXcd c;
  with_forms(
      s, [&](auto& forms, Execution& execution) { c = structure::balanced_coefficients(s.value, forms, execution); },
      callback(progress));
  return c;
}

py::array disk_map(Structure& s) {
  Eigen::VectorXcd z;
  with_forms(s, [&](auto& forms, Execution& execution) {
    z = flat::disk_map(s.value, forms.function(s.value.differentials.col(0), execution), execution.workers());
  });
  return copy(z);
}

py::array sphere_map(Structure& s) {
  flat::PointArray points;
  with_forms(s, [&](auto& forms, Execution& execution) {
    flat::require_sphere(s.value);
    points = flat::sphere_map(s.value, forms.function(s.value.differentials.col(0), execution), execution.workers());
  });
  return give_matrix(std::move(points));
}

// The same structure cut elsewhere; the forms are shared.
StructurePointer cut_along(const StructurePointer& s, const std::vector<int>& edges, const std::vector<int>& labels) {
  auto made = std::make_shared<Structure>();
  made->options = s->options;
  made->threads = s->threads;
  made->uncut = s->uncut ? s->uncut : s;
  with_forms(
      *s, [&](auto&, Execution& execution) { made->value = structure::cut_along(s->value, edges, labels, execution); });
  return made;
}

void bind_actions(py::class_<Structure, StructurePointer>& type) {
  type.def("prepare_uv", &prepare_uv, py::arg("progress"))
      .def("uv_solver", &uv_solver)
      .def("uv", &uv, py::arg("coefficients"))
      .def("basis_forms", &basis_forms)
      .def("balanced_coefficients", &balanced_coefficients, py::arg("progress"))
      .def("disk_map", &disk_map)
      .def("sphere_map", &sphere_map)
      .def("cut_along", &cut_along, py::arg("edges"), py::arg("labels"))
      .def(
          "require_memory",
          [](const Structure& s, const std::string& what, std::int64_t bytes) {
            structure::require_memory(what, bytes, s.options.memory_limit);
          },
          py::arg("what"), py::arg("bytes"));
}

void bind_values(py::class_<Structure, StructurePointer>& type) {
  type.def("surface", [](const Structure& s) { return std::const_pointer_cast<mesh::Surface>(s.value.surface); })
      .def("families", [](const Structure& s) { return s.value.topology.families; })
      .def("differentials", [](const Structure& s) { return copy(s.value.differentials); })
      .def("poles",
           [](const Structure& s) { return copy(s.value.poles ? s.value.poles->chosen.vertices : std::vector<int>()); })
      .def("residues",
           [](const Structure& s) {
             return copy(s.value.poles ? s.value.poles->chosen.residues : std::vector<std::complex<double>>());
           })
      .def("spokes", [](const Structure& s) { return copy(structure::spokes(s.value)); })
      .def("collapsed_triangles",
           [](const Structure& s) {
             return copy(mesh::triangles_on_one_loop(*s.value.surface, s.value.topology.boundary));
           })
      .def("memory", [](const Structure& s) { return s.value.record.memory; })
      .def("solver", [](const Structure& s) { return s.value.record.solver; })
      .def("timings", [](const Structure& s) { return s.value.record.seconds; })
      .def_readonly("threads", &Structure::threads);
}

void bind_structure(py::module_& m) {
  using structure::Families;
  py::class_<Families>(m, "Families")
      .def_readonly("natural", &Families::natural)
      .def_readonly("dirichlet", &Families::dirichlet)
      .def_readonly("poles", &Families::poles)
      .def_property_readonly("count", &Families::count);
  py::class_<Structure, StructurePointer> type(m, "Structure");
  bind_actions(type);
  bind_values(type);
  bind_topology(type);
  bind_invariants(type);
  m.def("conformal_structure", &conformal, py::arg("surface"), py::arg("over_double"), py::arg("solver"),
        py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("pole_structure", &with_poles, py::arg("surface"), py::arg("poles"), py::arg("residues"), py::arg("labels"),
        py::arg("solver"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("paper_structure", &paper, py::arg("surface"), py::arg("thresholds"), py::arg("threads"),
        py::arg("memory_limit"), py::arg("progress"));
  m.def("conformal_structure_of_level", &conformal_of_level, py::arg("mesh"), py::arg("splits"), py::arg("surface"),
        py::arg("solver"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
  m.def("paper_structure_of_level", &paper_of_level, py::arg("mesh"), py::arg("splits"), py::arg("surface"),
        py::arg("thresholds"), py::arg("threads"), py::arg("memory_limit"), py::arg("progress"));
}

}  // namespace

void bind_structures(py::module_& m) {
  bind_laplace_problem(m);
  bind_structure(m);
}

}  // namespace holomorph::bindings
