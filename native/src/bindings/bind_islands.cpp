#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "islands/cuts_to_disks.h"
#include "islands/filling.h"
#include "islands/flattening.h"
#include "islands/joining.h"
#include "islands/parting.h"

namespace holomorph::bindings {
namespace {

using islands::Flattening;

// (#E,) flags
py::array cuts_to_disks(const mesh::Surface& surface, const py::object& progress) {
  Execution execution(1, callback(progress));
  std::vector<char> cuts;
  {
    const py::gil_scoped_release unlocked;
    execution.stage("cuts", 0.0, 1.0);
    cuts = islands::cuts_to_disks(surface, execution);
  }
  return copy(cuts);
}

std::shared_ptr<mesh::Surface> filled(const mesh::Surface& surface) {
  Execution execution(1);
  const py::gil_scoped_release unlocked;
  return std::make_shared<mesh::Surface>(islands::filled(surface, execution));
}

Flattening flattened(const mesh::Surface& surface, int threads, const py::object& progress) {
  Execution execution(threads, callback(progress));
  const py::gil_scoped_release unlocked;
  return islands::flattened(surface, execution);
}

// (#C, 2) UVs
py::array evened(const mesh::Surface& surface, const Flattening& flattening, double evenness, int threads,
                 const py::object& progress) {
  Execution execution(threads, callback(progress));
  uv::UvArray uv;
  {
    const py::gil_scoped_release unlocked;
    uv = islands::evened(surface, flattening, evenness, execution);
  }
  return give_matrix(std::move(uv));
}

// (#C, 2) UVs and the nets of the components. The facade has made the arguments.
py::tuple joined(const mesh::Surface& surface, const Contiguous<double>& uv, const Contiguous<int>& joints,
                 const Contiguous<char>& is_joinable) {
  uv::UvArray moved = Eigen::Map<const uv::UvArray>(uv.data(), uv.shape(0), 2);
  const auto pairs = rows<int, 4>(joints);
  const auto flags = values<char>(is_joinable);
  std::vector<int> nets;
  {
    const py::gil_scoped_release unlocked;
    nets = islands::joined(surface, moved, pairs, flags);
  }
  return py::make_tuple(give_matrix(std::move(moved)), give(std::move(nets)));
}

// (#F,) the part of each polygon
py::array parted(const mesh::Surface& surface, const Contiguous<double>& uv) {
  const uv::UvArray flat = Eigen::Map<const uv::UvArray>(uv.data(), uv.shape(0), 2);
  std::vector<int> parts;
  {
    const py::gil_scoped_release unlocked;
    parts = islands::parted(surface, flat);
  }
  return give(std::move(parts));
}

}  // namespace

void bind_islands(py::module_& m) {
  py::class_<Flattening>(m, "Flattening")
      .def_property_readonly("scale_factors", [](const Flattening& flat) { return copy(flat.scale_factors); })
      .def_property_readonly("is_flat", [](const Flattening& flat) { return copy(flat.is_flat); });
  m.def("cuts_to_disks", &cuts_to_disks, py::arg("surface"), py::arg("progress"));
  m.def("filled", &filled, py::arg("surface"));
  m.def("flattened", &flattened, py::arg("surface"), py::arg("threads"), py::arg("progress"));
  m.def("evened_islands", &evened, py::arg("surface"), py::arg("flattening"), py::arg("evenness"), py::arg("threads"),
        py::arg("progress"));
  m.def("parted", &parted, py::arg("surface"), py::arg("uv"));
  m.def("joined", &joined, py::arg("surface"), py::arg("uv"), py::arg("joints"), py::arg("is_joinable"));
}

}  // namespace holomorph::bindings
