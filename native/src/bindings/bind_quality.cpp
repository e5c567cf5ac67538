// How good a map is: distortion, direction, overlaps, and what they cost.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "uv/appearance.h"
#include "uv/direction.h"
#include "uv/quality.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using uv::Distortion;
using uv::Quality;

// compute(workers), without the interpreter's lock.
template <class Compute>
auto measured(int threads, const Compute& compute) {
  const py::gil_scoped_release released;
  Workers workers(threads);
  return compute(workers);
}

Quality quality(const mesh::Surface& surface, const Contiguous<double>& uv, int threads) {
  return measured(threads, [&](Workers& workers) { return uv::quality(surface, corners(uv), workers); });
}

template <class T>
Array<T> array(const Contiguous<T>& values) {
  return {values.data(), values.data() + values.size()};
}

// The facade's own value.
Quality quality_of(const Contiguous<double>& angle, const Contiguous<double>& area, const Contiguous<bool>& flipped,
                   const Contiguous<double>& weights, double flipped_part, double lost_part, double mean_angle,
                   double density_ratio, double median_density, std::optional<double> overlapping_part,
                   double unseen_angle, std::optional<uv::Direction> direction) {
  const py::ssize_t count = weights.size();
  if (angle.size() != count || area.size() != count || flipped.size() != count)
    throw py::value_error("a quality needs one angle, area, flag and weight for each triangle");
  return {array(angle),     array(area),   {flipped.data(), flipped.data() + flipped.size()},
          array(weights),   flipped_part,  lost_part,
          mean_angle,       density_ratio, median_density,
          overlapping_part, unseen_angle,  std::move(direction)};
}

Quality joined(const std::vector<const Quality*>& qualities, const std::vector<double>& densities) {
  return measured(1, [&](Workers& workers) { return uv::joined(qualities, densities, workers); });
}

uv::Direction direction(const mesh::Surface& surface, const Contiguous<double>& uv, const std::string& up, int turns) {
  return measured(1,
                  [&](Workers& workers) { return uv::direction(surface, corners(uv), up_axis(up), turns, workers); });
}

// Any polygons, which no surface has checked.
mesh::Polygons polygons(const Contiguous<double>& vertices, const Contiguous<int>& corner_vertices,
                        const Contiguous<int>& face_offsets, const Contiguous<double>& uv) {
  const auto has_columns = [](const Contiguous<double>& array, py::ssize_t count) {
    return array.ndim() == 2 && array.shape(1) == count;
  };
  if (!has_columns(vertices, 3) || !has_columns(uv, 2) || uv.shape(0) != corner_vertices.size())
    throw py::value_error("(#V, 3) positions and (#C, 2) UVs are needed");
  mesh::Polygons result{rows<double, 3>(vertices), values(corner_vertices), values(face_offsets)};
  const auto is_vertex = [&](int v) { return v >= 0 && v < std::ssize(result.vertices); };
  const auto& offsets = result.face_offsets;
  if (!std::ranges::all_of(result.corner_vertices, is_vertex) || offsets.empty() || offsets.front() != 0 ||
      offsets.back() != corner_vertices.size() || !std::ranges::is_sorted(offsets))
    throw py::index_error("corners name vertices that are not there, or offsets are not those of their polygons");
  return result;
}

Distortion distortion(const Contiguous<double>& vertices, const Contiguous<int>& corner_vertices,
                      const Contiguous<int>& face_offsets, const Contiguous<double>& uv, const std::string& up) {
  const mesh::Polygons drawn = polygons(vertices, corner_vertices, face_offsets, uv);
  return measured(1, [&](Workers& workers) { return uv::distortion(drawn, corners(uv), up_axis(up), workers); });
}

double drawn_density(const Contiguous<double>& vertices, const Contiguous<int>& corner_vertices,
                     const Contiguous<int>& face_offsets, const Contiguous<double>& uv) {
  const mesh::Polygons drawn = polygons(vertices, corner_vertices, face_offsets, uv);
  return measured(1, [&](Workers& workers) { return uv::drawn_densities(drawn, corners(uv), workers).median; });
}

double overlapping_part(const Contiguous<std::complex<double>>& curve, const py::object& progress) {
  if (curve.ndim() != 2 || curve.shape(1) != 2) throw py::value_error("a curve is an (n, 2) array of ends");
  std::vector<uv::Ends> edges(curve.shape(0));
  for (std::size_t k = 0; k < edges.size(); ++k) edges[k] = {curve.data()[2 * k], curve.data()[2 * k + 1]};
  Execution execution(1, callback(progress));
  const py::gil_scoped_release released;
  execution.stage("overlaps", 0, 1);
  return uv::overlapping_part(edges, execution);
}

void bind_measures(py::module_& m) {
  const auto of_direction = [](auto member) {
    return [member](py::object self) { return view(self.cast<const uv::Direction&>().*member, self); };
  };
  py::class_<uv::Direction>(m, "Direction")
      .def(py::init([](const Contiguous<double>& angle, const Contiguous<double>& steep, double area, int turns) {
             return uv::Direction{array(angle), array(steep), area, turns};
           }),
           "angle"_a, "steep"_a, "area"_a, "turns"_a)
      .def_property_readonly("angle", of_direction(&uv::Direction::angle))
      .def_property_readonly("steep", of_direction(&uv::Direction::steep))
      .def_readonly("area", &uv::Direction::area)
      .def_readonly("turns", &uv::Direction::turns);
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Quality&>().*member, self); };
  };
  py::class_<Quality>(m, "Quality")
      .def(py::init(&quality_of), "angle"_a, "area"_a, "flipped"_a, "weights"_a, "flipped_part"_a, "lost_part"_a,
           "mean_angle"_a, "density_ratio"_a, "median_density"_a, "overlapping_part"_a, "unseen_angle"_a, "direction"_a)
      .def_property_readonly("angle", viewed(&Quality::angle))
      .def_property_readonly("area", viewed(&Quality::area))
      .def_property_readonly(
          "flipped",
          [](py::object self) { return view(self.cast<const Quality&>().flipped, self).attr("view")("bool"); })
      .def_property_readonly("weights", viewed(&Quality::weights))
      .def_readonly("flipped_part", &Quality::flipped_part)
      .def_readonly("lost_part", &Quality::lost_part)
      .def_readonly("mean_angle", &Quality::mean_angle)
      .def_readonly("density_ratio", &Quality::density_ratio)
      .def_readonly("median_density", &Quality::median_density)
      .def_readonly("overlapping_part", &Quality::overlapping_part)
      .def_readonly("unseen_angle", &Quality::unseen_angle)
      .def_readonly("direction", &Quality::direction);
  const auto of_polygons = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Distortion&>().*member, self); };
  };
  py::class_<Distortion>(m, "Distortion")
      .def_property_readonly("density", of_polygons(&Distortion::density))
      .def_property_readonly("angle", of_polygons(&Distortion::angle))
      .def_property_readonly("direction", of_polygons(&Distortion::direction))
      .def_readonly("size_range", &Distortion::size_range)
      .def_readonly("mean_angle", &Distortion::mean_angle)
      .def_readonly("upright_part", &Distortion::upright_part);
}

}  // namespace

void bind_quality(py::module_& m) {
  bind_measures(m);
  m.attr("most_octaves") = uv::kMostOctaves;
  m.attr("collapsed_angle") = uv::kCollapsedAngle;
  m.attr("prices") =
      py::dict("shear"_a = uv::kShear, "flipped"_a = uv::kFlipped, "rounding"_a = uv::kRounding, "seam"_a = uv::kSeam,
               "hard_seam"_a = uv::kHardSeam, "pole"_a = uv::kPole, "cone"_a = uv::kCone, "turn"_a = uv::kTurn,
               "sideways"_a = uv::kSideways, "on_its_head"_a = uv::kOnItsHead);
  m.def("quality", &quality, "surface"_a, "uv"_a, "threads"_a);
  m.def("joined", &joined, "qualities"_a, "densities"_a);
  m.def("direction", &direction, "surface"_a, "uv"_a, "up"_a, "turns"_a);
  m.def("distortion", &distortion, "vertices"_a, "corner_vertices"_a, "face_offsets"_a, "uv"_a, "up"_a);
  m.def("drawn_density", &drawn_density, "vertices"_a, "corner_vertices"_a, "face_offsets"_a, "uv"_a);
  m.def("overlapping_part", &overlapping_part, "curve"_a, "progress"_a);
  m.def(
      "cost_of_squares",
      [](double density_ratio, double mean_angle, double flipped_part, double overlapping_part) {
        return uv::cost_of_squares({density_ratio, mean_angle, flipped_part, overlapping_part});
      },
      "density_ratio"_a, "mean_angle"_a, "flipped_part"_a, "overlapping_part"_a);
  m.def("cost_of_overlaps", &uv::cost_of_overlaps, "overlapping_part"_a);
  m.def(
      "cost_of_direction",
      [](const Contiguous<double>& angle, const Contiguous<double>& steep, double area) {
        return uv::cost_of_direction({array(angle), array(steep), area});
      },
      "angle"_a, "steep"_a, "area"_a);
  m.def(
      "cost_of_marks",
      [](double soft_seams, double hard_seams, int poles, int cones) {
        return uv::cost_of_marks({soft_seams, hard_seams, poles, cones});
      },
      "soft_seams"_a, "hard_seams"_a, "poles"_a, "cones"_a);
}

}  // namespace holomorph::bindings
