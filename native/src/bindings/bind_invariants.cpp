#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/records.h"
#include "bindings/structure_with_forms.h"
#include "conformal/certain_bounds.h"
#include "structure/nested_level.h"

namespace holomorph::bindings {
namespace {

py::list matrices(const std::vector<Eigen::MatrixXd>& list) {
  py::list result;
  for (const auto& matrix : list) result.append(copy(matrix));
  return result;
}

}  // namespace

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
               below.push_back(conformal::below_inverse(gram));
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
            s.value = structure::narrowed(std::move(s.value), {std::move(gram), std::move(certain)}, metric);
          },
          py::arg("gram"), py::arg("certain"), py::arg("metric_error"))
      .def("flip_count", [](const Structure& s) { return s.value.record.flip_count; })
      .def("mollification", [](const Structure& s) { return s.value.record.mollification; })
      .def("metric_error", [](const Structure& s) { return s.value.harmonic.certificate.metric; });
}

}  // namespace holomorph::bindings
