#include "bindings/bindings.h"
#include "bindings/structure_methods.h"

namespace holomorph::bindings {
namespace {

using pipeline::BoundedStructure;
using Bounded = Structure<BoundedStructure>;

std::shared_ptr<Bounded> compute(std::shared_ptr<mesh::Surface> surface, const std::string& boundary,
                                 const std::string& solver, int threads, std::int64_t memory_limit,
                                 const py::object& execution) {
  const pipeline::Options chosen{solver, threads, memory_limit, boundary};
  return make_structure<BoundedStructure>(surface, chosen, execution, [&](const auto& options, auto& p) {
    return pipeline::bounded_structure(*surface, options, p);
  });
}

py::array balanced(Bounded& s) {
  const auto& holomorphic = s.value.holomorphic;
  const Eigen::VectorXd c =
      balanced_coefficients(s, holomorphic.coefficients, holomorphic.projected.natural_gram, uv::Coefficients::real)
          .real();
  return read_only(copy(c).attr("reshape")(c.size()));
}

}  // namespace

void bind_bounded_structure(py::module_& m) {
  bind_structure<BoundedStructure>(m, "BoundedStructure")
      .def("homology_basis", [](const Bounded& s) { return loops_of_vertices(*s.surface, s.value.homology_basis); })
      .def("boundary_loops", [](const Bounded& s) { return loops_of_vertices(*s.surface, s.value.boundary.loops); })
      .def("balanced_coefficients", &balanced)
      .def("pairing", [](const Bounded& s) { return copy(s.value.pairing); })
      .def("gram_matrices",
           [](const Bounded& s) { return py::make_tuple(copy(s.value.natural_gram), copy(s.value.dirichlet_gram)); })
      .def("projected",
           [](const Bounded& s) {
             const auto& p = s.value.holomorphic.projected;
             return py::make_tuple(copy(p.natural_gram), copy(p.dirichlet_gram), copy(p.star), copy(p.lower));
           })
      .def("coefficients", [](const Bounded& s) { return copy(s.value.holomorphic.coefficients); })
      .def("period_matrix", [](const Bounded& s) { return copy(s.value.holomorphic.period_matrix); })
      .def("period_bounds",
           [](const Bounded& s) {
             return py::make_tuple(copy(s.value.holomorphic.bounds.lower), copy(s.value.holomorphic.bounds.upper));
           })
      .def("collapsed_triangles", [](const Bounded& s) { return copy(s.value.collapsed_triangles); })
      .def("residuals", [](const Bounded& s) {
        return py::make_tuple(s.value.residuals.closedness, s.value.residuals.harmonicity, s.value.period_residual,
                              s.value.pairing_residual);
      });
  m.def("bounded_structure", &compute);
}

}  // namespace holomorph::bindings
