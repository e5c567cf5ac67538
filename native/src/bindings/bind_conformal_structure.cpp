#include "bindings/bindings.h"
#include "bindings/structure_methods.h"
#include "pipeline/harmonic_map.h"

namespace holomorph::bindings {
namespace {

using mesh::Surface;
using pipeline::ConformalStructure;
using Closed = Structure<ConformalStructure>;

std::shared_ptr<Closed> compute(std::shared_ptr<Surface> surface, const std::string& solver, int threads,
                                std::int64_t memory_limit, const py::object& execution) {
  return make_structure<ConformalStructure>(
      surface, {solver, threads, memory_limit}, execution,
      [&](const auto& options, auto& p) { return pipeline::conformal_structure(*surface, options, p); });
}

// Of a level of a progressive mesh, in the classes of its base; `surface` is the surface of that level.
std::shared_ptr<Closed> compute_level(const progressive::ProgressiveMesh& mesh, int splits,
                                      std::shared_ptr<Surface> surface, const std::string& solver, int threads,
                                      std::int64_t memory_limit, const py::object& execution) {
  return make_structure<ConformalStructure>(
      surface, {solver, threads, memory_limit}, execution, [&](const auto& options, auto& p) {
        if (options.solver == "paper") {
          return pipeline::conformal_structure(*surface, options, p, {},
                                               pipeline::paper_levels(mesh, splits, *surface));
        }
        return pipeline::conformal_structure(*surface, options, p, topology::carried_bases(mesh, splits, *surface));
      });
}

py::array balanced(Closed& s) {
  const auto& holomorphic = s.value.holomorphic;
  const Eigen::VectorXcd c =
      balanced_coefficients(s, holomorphic.periods, holomorphic.period_matrix.imag(), uv::Coefficients::complex);
  return read_only(copy(c).attr("reshape")(c.size()));
}

// Moves of the vertices, and the solver's report.
py::tuple harmonic_map(const Surface& surface, const Contiguous<double>& corner_values, const std::string& solver,
                       int threads, const py::object& progress_function) {
  using Rows = forms::RowMajorMatrix;
  const Rows given = Eigen::Map<const Rows>(corner_values.data(), corner_values.shape(0), corner_values.shape(1));
  Execution execution(threads, callback(progress_function));
  pipeline::HarmonicMap map;
  {
    const py::gil_scoped_release unlocked;
    map = pipeline::harmonic_map(surface, given, {solver, threads}, execution);
  }
  return py::make_tuple(copy(map.moves), report(map.solver));
}

}  // namespace

void bind_conformal_structure(py::module_& m) {
  bind_structure<ConformalStructure>(m, "ConformalStructure")
      .def("homology_basis", [](const Closed& s) { return loops_of_vertices(*s.surface, s.value.homology_basis); })
      .def("balanced_coefficients", &balanced)
      .def("intersection_matrix", [](const Closed& s) { return copy(s.value.canonical.intersection); })
      .def("canonical_basis", [](const Closed& s) { return copy(s.value.canonical.cycles); })
      .def("gram_matrix", [](const Closed& s) { return copy(s.value.gram_matrix); })
      .def("period_matrix", [](const Closed& s) { return copy(s.value.holomorphic.period_matrix); })
      .def("period_bounds",
           [](const Closed& s) {
             return py::make_tuple(copy(s.value.holomorphic.lower), copy(s.value.holomorphic.upper));
           })
      .def("periods", [](const Closed& s) { return copy(s.value.holomorphic.periods); })
      .def("memory",
           [](const Closed& s) {
             return py::make_tuple(s.value.memory.keep_forms, s.value.memory.block, s.value.memory.bytes);
           })
      .def("residuals", [](const Closed& s) {
        return py::make_tuple(s.value.residuals.closedness, s.value.residuals.harmonicity, s.value.period_residual,
                              s.value.asymmetry);
      });
  m.def("conformal_structure", &compute);
  m.def("conformal_structure_of_level", &compute_level);
  m.def("harmonic_map", &harmonic_map);
}

}  // namespace holomorph::bindings
