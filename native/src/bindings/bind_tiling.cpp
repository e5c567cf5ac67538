#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <mutex>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "tiling/tiler.h"
#include "uv/zeros.h"

namespace holomorph::bindings {
namespace {

using tiling::Tiler;
using tiling::Tiling;

/// A tiler for Python, which does one thing at a time.
struct PyTiler {
  int threads;
  Tiler value;
  std::mutex mutex;

  PyTiler(const std::shared_ptr<mesh::Surface>& surface, bool straight, const std::vector<int>& names,
          const std::string& solver, int thread_count)
      : threads(thread_count), value(surface, structure::Options{solver}, straight, names) {}

  /// `use(tiler, execution)` without the interpreter's lock.
  template <class Use>
  auto run(const py::object& progress, Use use) {
    Execution execution(threads, callback(progress));
    const py::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex);
    return use(value, execution);
  }
};

}  // namespace

void bind_tiling(py::module_& m) {
  py::class_<Tiling, std::shared_ptr<Tiling>>(m, "Tiling")
      .def("uv", [](const Tiling& t) { return copy(t.uv); })
      .def("periods", [](const Tiling& t) { return copy(t.periods); })
      .def("poles", [](const Tiling& t) { return copy(t.poles); })
      .def("residues", [](const Tiling& t) { return copy(t.residues); })
      .def("surface", [](const Tiling& t) { return std::const_pointer_cast<mesh::Surface>(t.structure->surface); })
      .def("zeros",
           [](const Tiling& t) {
             std::vector<int> vertices, orders;
             for (const auto& [vertex, order] : uv::zeros(*t.structure->surface, t.uv, t.poles)) {
               vertices.push_back(vertex);
               orders.push_back(order);
             }
             return py::make_tuple(copy(vertices), copy(orders));
           })
      .def("seams", [](const Tiling& t) { return copy(t.structure->topology.seams); })
      .def_readonly("tiles", &Tiling::tiles)
      .def_readonly("distortion", &Tiling::distortion)
      .def_readonly("left_over", &Tiling::left_over);
  py::class_<PyTiler>(m, "Tiler")
      .def(py::init<const std::shared_ptr<mesh::Surface>&, bool, const std::vector<int>&, const std::string&, int>())
      .def("place",
           [](PyTiler& t, std::optional<int> count, std::vector<int> vertices, const std::vector<bool>& allowed,
              const py::object& progress) {
             const tiling::PoleWishes wishes{count, std::move(vertices), {allowed.begin(), allowed.end()}};
             t.run(progress, [&](Tiler& tiler, Execution& execution) { tiler.place(wishes, execution); });
           })
      .def("poles",
           [](const PyTiler& t) {
             return py::make_tuple(copy(t.value.poles().vertices), copy(t.value.poles().residues),
                                   t.value.optimal_density_ratio());
           })
      .def("tile",
           [](PyTiler& t, double tiles, std::complex<double> a, std::complex<double> b, std::optional<double> turn,
              std::optional<std::array<double, 3>> direction, double most_turn, const py::object& progress) {
             return t.run(progress, [&](Tiler& tiler, Execution& execution) {
               return std::make_shared<Tiling>(tiler.tile({tiles, {a, b}, direction, turn, most_turn}, execution));
             });
           })
      .def("with_poles_moved",
           [](PyTiler& t, const std::vector<std::pair<int, int>>& pairs, const py::object& progress) {
             std::vector<tiling::PoleMove> moves;
             for (const auto& [pole, vertex] : pairs) moves.push_back({pole, vertex});
             return t.run(progress, [&](Tiler& tiler, Execution& execution) {
               return std::make_shared<Tiling>(tiler.with_poles_moved(moves, execution));
             });
           });
}

}  // namespace holomorph::bindings
