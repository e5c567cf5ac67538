// Maps in islands, and how rectangles are packed.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "flat/arrangement.h"
#include "flat/pieces.h"
#include "flat/split_overlaps.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
// (#F,) the part of each polygon
py::array parted(const mesh::Surface& surface, const Contiguous<double>& uv, const py::object& progress) {
  const uv::UvArray flat = Eigen::Map<const uv::UvArray>(uv.data(), uv.shape(0), 2);
  std::vector<int> parts;
  Execution execution(1, callback(progress));
  {
    const py::gil_scoped_release unlocked;
    execution.stage("overlaps", 0.0, 1.0);
    parts = flat::parted(surface, flat, execution);
  }
  return give(std::move(parts));
}

py::array as_array(const std::vector<flat::Extent>& rows) {
  py::array_t<double> result({static_cast<py::ssize_t>(rows.size()), py::ssize_t{2}});
  std::copy_n(rows.data()->data(), result.size(), result.mutable_data());
  return read_only(std::move(result));
}

// ((n, 2) lower left corners, (w, h) of the whole)
std::pair<py::array, std::pair<double, double>> on_shelves(const Contiguous<double>& sizes, double width, double gap) {
  const flat::Shelves made = flat::on_shelves(rows<double, 2>(sizes), width, gap);
  return {as_array(made.corners), {made.whole[0], made.whole[1]}};
}

// ((n, 2) lower left corners, side)
std::pair<py::array, double> pack(const Contiguous<double>& sizes, double margin) {
  const flat::Packing made = flat::pack(rows<double, 2>(sizes), margin);
  return {as_array(made.corners), made.side};
}

using SurfacePointer = std::shared_ptr<mesh::Surface>;

// [(surface, indices of its vertices, polygons and corners)]
using Parts = std::vector<std::tuple<SurfacePointer, py::array, py::array, py::array>>;

Parts given(std::vector<mesh::Component> parts) {
  Parts result;
  for (mesh::Component& part : parts) {
    result.emplace_back(std::make_shared<mesh::Surface>(std::move(part.surface)), give(std::move(part.vertex_index)),
                        give(std::move(part.face_index)), give(std::move(part.corner_index)));
  }
  return result;
}

Parts cut_apart(const mesh::Surface& surface, const Contiguous<int>& names) {
  std::vector<mesh::Component> parts;
  {
    const std::vector<int> own = values(names);
    const py::gil_scoped_release unlocked;
    Execution execution;
    parts = flat::cut_apart(surface, own, execution);
  }
  return given(std::move(parts));
}

// (the parts, how far the cut is seen)
std::pair<Parts, double> cut_in_hiding(const mesh::Surface& surface, const std::optional<std::array<double, 3>>& up,
                                       int threads, const py::object& progress) {
  flat::CutInHiding cut;
  {
    Execution execution(threads, callback(progress));
    const py::gil_scoped_release unlocked;
    cut = flat::cut_in_hiding(surface, up, execution);
  }
  return {given(std::move(cut.parts)), cut.seen};
}

}  // namespace

void bind_islands(py::module_& m) {
  m.def("parted", &parted, "surface"_a, "uv"_a, "progress"_a);
  m.def("cut_apart", &cut_apart, "surface"_a, "names"_a);
  m.def("cut_in_hiding", &cut_in_hiding, "surface"_a, "up"_a, py::kw_only(), "threads"_a, "progress"_a);
  m.def("on_shelves", &on_shelves, "sizes"_a, "width"_a, "gap"_a);
  m.def("pack", &pack, "sizes"_a, "margin"_a);
  m.def("fitting_margin", &flat::fitting_margin, "margin"_a, "count"_a);
}

}  // namespace holomorph::bindings
