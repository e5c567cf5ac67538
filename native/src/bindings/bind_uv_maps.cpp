#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/records.h"
#include "evening/evening.h"
#include "forms/averaged_star.h"
#include "multiresolution/harmonic_map.h"
#include "uv/placement.h"
#include "uv/quality.h"

namespace holomorph::bindings {
namespace {

using Complex = std::complex<double>;

Eigen::Map<const uv::UvArray> corners(const Contiguous<double>& uv) { return {uv.data(), uv.shape(0), 2}; }

uv::Quality quality(const mesh::Surface& surface, const Contiguous<double>& uv, int threads) {
  const py::gil_scoped_release unlocked;
  Workers workers(threads);
  return uv::quality(surface, corners(uv), workers);
}

uv::Frame frame(const mesh::Surface& surface, const Contiguous<double>& uv, double rotation, int threads) {
  const py::gil_scoped_release unlocked;
  Workers workers(threads);
  return uv::frame(surface, corners(uv), rotation, workers);
}

Zeros zeros(const mesh::Surface& surface, const Contiguous<double>& uv, const std::vector<int>& poles) {
  return zeros_of_map(surface, corners(uv), poles);
}

// The facade has checked shapes and types; `rows` is empty where row c is that of corner c.
void place(const Contiguous<double>& uv, Complex factor, Complex origin, Complex target,
           const py::array_t<int, py::array::c_style>& rows, py::array_t<double, py::array::c_style> placed,
           int threads) {
  double* const values = placed.mutable_data();
  const int* const at = rows.size() == 0 ? nullptr : rows.data();
  const py::gil_scoped_release unlocked;
  Workers workers(threads);
  uv::place(corners(uv), {factor, origin, target}, at, values, workers);
}

multiresolution::HarmonicMap harmonic_map(const mesh::Surface& surface, const Contiguous<double>& corner_values,
                                          const std::string& solver, int threads, const py::object& progress_function) {
  using Rows = forms::RowMajorMatrix;
  const Rows given = Eigen::Map<const Rows>(corner_values.data(), corner_values.shape(0), corner_values.shape(1));
  Execution execution(threads, callback(progress_function));
  const py::gil_scoped_release unlocked;
  return multiresolution::harmonic_map(surface, given, {solver}, execution);
}

// #V x 2. The facade has checked shapes and vertices, and that the surface is connected.
py::array evened(const mesh::Surface& surface, const Contiguous<double>& uv, std::vector<int> poles, std::vector<int> u,
                 std::vector<int> v, double evenness, const std::string& solver, int threads,
                 const py::object& progress) {
  const uv::UvArray given = corners(uv);
  uv::UvArray result;
  Execution execution(threads, callback(progress));
  {
    const py::gil_scoped_release unlocked;
    execution.stage("evening", 0.0, 1.0);
    result =
        evening::evened(surface, given, {std::move(poles), std::move(u), std::move(v)}, evenness, execution, solver);
    execution.finish();
  }
  return give_matrix(std::move(result));
}

// The surface's own triangles, those without area mollified.
mesh::IntrinsicTriangulation own_triangles(const mesh::Surface& surface, Execution& execution) {
  return mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
}

// The star of a form on the edges of any surface.
py::array averaged_star(const mesh::Surface& surface, const Contiguous<double>& form) {
  if (form.size() != static_cast<py::ssize_t>(surface.edges.size()))
    throw py::value_error("a form needs one value for each edge");
  Execution execution;
  return copy(forms::averaged_star(own_triangles(surface, execution), values(form)));
}

// (#E,) on the surface's own triangles.
py::array edge_weights(const mesh::Surface& surface) {
  Execution execution;
  return give(mesh::cotangent_weights(own_triangles(surface, execution), execution));
}

}  // namespace

void bind_uv_maps(py::module_& m) {
  using multiresolution::HarmonicMap;
  using uv::Quality;
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Quality&>().*member, self); };
  };
  py::class_<Quality>(m, "Quality")
      .def_property_readonly("angle", viewed(&Quality::angle))
      .def_property_readonly("area", viewed(&Quality::area))
      .def_property_readonly(
          "flipped",
          [](py::object self) { return view(self.cast<const Quality&>().flipped, self).attr("view")("bool"); })
      .def_readonly("mean_angle", &Quality::mean_angle)
      .def_readonly("density_ratio", &Quality::density_ratio)
      .def_readonly("median_density", &Quality::median_density);
  py::class_<uv::Frame>(m, "Frame")
      .def_readonly("low", &uv::Frame::low)
      .def_readonly("high", &uv::Frame::high)
      .def_readonly("area", &uv::Frame::area);
  py::class_<HarmonicMap>(m, "HarmonicMap")
      .def_property_readonly("moves", [](const HarmonicMap& map) { return copy(map.moves); })
      .def_readonly("solver", &HarmonicMap::solver);
  m.def("quality", &quality, py::arg("surface"), py::arg("uv"), py::arg("threads"));
  m.def("evened", &evened, py::arg("surface"), py::arg("uv"), py::kw_only(), py::arg("poles"), py::arg("u"),
        py::arg("v"), py::arg("evenness"), py::arg("solver"), py::arg("threads"), py::arg("progress"));
  m.def("zeros", &zeros, py::arg("surface"), py::arg("uv"), py::arg("poles"));
  m.def("frame", &frame, py::arg("surface"), py::arg("uv"), py::arg("rotation"), py::arg("threads"));
  m.def("place", &place, py::arg("uv"), py::arg("factor"), py::arg("origin"), py::arg("target"), py::arg("rows"),
        py::arg("placed"), py::arg("threads"));
  m.def("harmonic_map", &harmonic_map, py::arg("surface"), py::arg("corner_values"), py::arg("solver"),
        py::arg("threads"), py::arg("progress"));
  m.def("averaged_star", &averaged_star, py::arg("surface"), py::arg("form"));
  m.def("edge_weights", &edge_weights, py::arg("surface"));
}

}  // namespace holomorph::bindings
