#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/solver_report.h"
#include "forms/averaged_star.h"
#include "multiresolution/harmonic_map.h"
#include "uv/placement.h"
#include "uv/quality.h"
#include "uv/zeros.h"

namespace holomorph::bindings {
namespace {

using Complex = std::complex<double>;

Eigen::Map<const uv::UvArray> corners(const Contiguous<double>& uv) { return {uv.data(), uv.shape(0), 2}; }

py::tuple quality(const mesh::Surface& surface, const Contiguous<double>& uv, int threads) {
  uv::Quality q;
  {
    const py::gil_scoped_release unlocked;
    Workers workers(threads);
    q = uv::quality(surface, corners(uv), workers);
  }
  const py::array flipped = give(std::move(q.flipped)).attr("view")("bool");
  return py::make_tuple(give(std::move(q.angle)), give(std::move(q.area)), flipped, q.mean_angle, q.density_ratio,
                        q.median_density);
}

py::tuple frame(const mesh::Surface& surface, const Contiguous<double>& uv, double rotation, int threads) {
  uv::Frame found;
  {
    const py::gil_scoped_release unlocked;
    Workers workers(threads);
    found = uv::frame(surface, corners(uv), rotation, workers);
  }
  return py::make_tuple(found.low, found.high, found.area);
}

// Vertices and orders.
py::tuple zeros(const mesh::Surface& surface, const Contiguous<double>& uv, const std::vector<int>& poles) {
  std::vector<int> vertices, orders;
  for (const auto& [vertex, order] : uv::zeros(surface, corners(uv), poles)) {
    vertices.push_back(vertex);
    orders.push_back(order);
  }
  return py::make_tuple(copy(vertices), copy(orders));
}

// The facade has checked shapes and types; `rows` is empty where row c is that of corner c.
void place(const Contiguous<double>& uv, Complex factor, Complex origin, Complex target,
           const py::array_t<int, py::array::c_style>& rows, py::array_t<float, py::array::c_style> placed,
           int threads) {
  float* const values = placed.mutable_data();
  const int* const at = rows.size() == 0 ? nullptr : rows.data();
  const py::gil_scoped_release unlocked;
  Workers workers(threads);
  uv::place(corners(uv), {factor, origin, target}, at, values, workers);
}

// Moves of the vertices, and the solver's report.
py::tuple harmonic_map(const mesh::Surface& surface, const Contiguous<double>& corner_values, const std::string& solver,
                       int threads, const py::object& progress_function) {
  using Rows = forms::RowMajorMatrix;
  const Rows given = Eigen::Map<const Rows>(corner_values.data(), corner_values.shape(0), corner_values.shape(1));
  Execution execution(threads, callback(progress_function));
  multiresolution::HarmonicMap map;
  {
    const py::gil_scoped_release unlocked;
    map = multiresolution::harmonic_map(surface, given, {solver}, execution);
  }
  return py::make_tuple(copy(map.moves), report(map.solver));
}

// The star of a form on the edges of any surface.
py::array averaged_star(const mesh::Surface& surface, const Contiguous<double>& form) {
  if (form.size() != static_cast<py::ssize_t>(surface.edges.size()))
    throw py::value_error("a form has one value for each edge");
  Execution execution;
  const auto triangulation =
      mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, execution), execution.workers());
  return copy(forms::averaged_star(triangulation, values(form)));
}

}  // namespace

void bind_uv_maps(py::module_& m) {
  m.def("quality", &quality);
  m.def("zeros", &zeros);
  m.def("frame", &frame);
  m.def("place", &place);
  m.def("harmonic_map", &harmonic_map);
  m.def("averaged_star", &averaged_star);
}

}  // namespace holomorph::bindings
