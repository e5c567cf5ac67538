// Moduli: periods compared, surfaces mapped onto each other, nested levels that narrow bounds.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "forms/element_forms.h"
#include "forms/reference_element.h"
#include "mesh/intrinsic_surface.h"
#include "moduli/equivalence.h"
#include "moduli/pull_back_uv.h"
#include "moduli/similarities.h"
#include "structure/nested_level.h"

namespace holomorph::bindings {
namespace {

using moduli::PeriodLattice;
using SurfacePointer = std::shared_ptr<mesh::Surface>;

constexpr std::array<const char*, 4> kVerdicts{"indistinguishable", "mirror_image", "not_equivalent", "undecided"};

moduli::Comparison compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed,
                           const py::object& progress) {
  Execution execution(1, callback(progress));
  const py::gil_scoped_release unlocked;
  return moduli::compare(a, b, allowed, needed, moduli::kMostSteps, execution);
}

/// Those that were found, and whether these are all.
std::pair<std::vector<moduli::Isometry>, bool> isometries(const PeriodLattice& a, const PeriodLattice& b, int sign,
                                                          double slack, const py::object& progress) {
  moduli::Isometries made = unlocked(1, progress, [&](Execution& execution) {
    return moduli::isometries(a, b, {sign, slack}, execution);
  });
  return {std::move(made.found), made.is_complete};
}

std::optional<moduli::Similarity> similarity(const mesh::Surface& a, const mesh::Surface& b, int sign,
                                             const py::object& progress) {
  Execution execution(1, callback(progress));
  const py::gil_scoped_release unlocked;
  return moduli::similarity(a, b, sign, execution);
}

// The slopes of n forms on the edges in the triangles, #T x n x 2.
py::array form_slopes(const mesh::Surface& surface, const forms::RowMajorMatrix& values) {
  Execution execution;
  const Eigen::MatrixXd columns = moduli::slopes({surface, values}, execution);
  py::array_t<double> result({columns.cols() / 2, columns.rows(), Eigen::Index{2}});
  auto rows = result.mutable_unchecked<3>();
  for (Eigen::Index t = 0; t < columns.cols() / 2; ++t) {
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      for (Eigen::Index k = 0; k < 2; ++k) rows(t, i, k) = columns(i, 2 * t + k);
    }
  }
  return read_only(std::move(result));
}

// Takes (#V,) triangles, (#V, 3) barycentric coordinates and (#C', 2) UVs, and returns (#C, 2).
py::array carried_uv(const mesh::Surface& from, const Contiguous<int>& triangles, const Contiguous<double>& barycentric,
                     const mesh::Surface& to, const Contiguous<double>& uv, const py::object& progress) {
  const moduli::VertexImages images{values(triangles), rows<double, 3>(barycentric)};
  const auto* points = reinterpret_cast<const std::complex<double>*>(uv.data());
  const std::vector<std::complex<double>> given(points, points + uv.size() / 2);
  Execution execution(1, callback(progress));
  std::vector<std::complex<double>> carried;
  {
    const py::gil_scoped_release unlocked;
    execution.stage("texture", 0, 1);
    carried = moduli::carried_uv(from, images, to, given, execution);
    execution.finish();
  }
  return copy(Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(
      reinterpret_cast<const double*>(carried.data()), static_cast<Eigen::Index>(carried.size()), 2));
}

// p and q, (#T,) each, from (#V,) triangles and (#V, 3) barycentric coordinates.
std::pair<py::array, py::array> map_derivatives(const mesh::Surface& from, const Contiguous<int>& triangles,
                                                const Contiguous<double>& barycentric, const mesh::Surface& to,
                                                int sign, const py::object& progress) {
  const moduli::VertexImages images{values(triangles), rows<double, 3>(barycentric)};
  Execution execution(1, callback(progress));
  moduli::MapDerivatives made;
  {
    const py::gil_scoped_release unlocked;
    execution.stage("stretch of the map", 0, 1);
    made = moduli::map_derivatives(from, images, to, sign, execution);
    execution.finish();
  }
  return {give(std::move(made.p)), give(std::move(made.q))};
}

/// Arrays of `moduli::ConformalImages`.
struct Images {
  py::array vertices, triangles, barycentric, residuals;
};

/// A continuation that keeps what it is made of.
class Continuation {
 public:
  Continuation(SurfacePointer from, forms::RowMajorMatrix from_forms, SurfacePointer to, forms::RowMajorMatrix to_forms)
      : from_(std::move(from)),
        to_(std::move(to)),
        from_forms_(std::move(from_forms)),
        to_forms_(std::move(to_forms)),
        value_({*from_, from_forms_}, {*to_, to_forms_}, execution_) {}

  // From a vertex whose image is in the middle of a triangle.
  Images run(int vertex, int triangle, const Eigen::VectorXd& residual, std::size_t most_vertices,
             const py::object& progress) const {
    const auto corner = mesh::corners(*to_, triangle);
    const mesh::SurfacePoint middle{triangle, (corner[0] + corner[1] + corner[2]) / 3.0};
    Execution execution(1, callback(progress));
    moduli::ConformalImages images;
    {
      const py::gil_scoped_release unlocked;
      images = value_.run({vertex, middle, residual}, most_vertices, execution);
      execution.finish();
    }
    std::vector<int> triangles;
    Eigen::MatrixX3d barycentric(static_cast<Eigen::Index>(images.points.size()), 3);
    for (const mesh::SurfacePoint& point : images.points) {
      barycentric.row(static_cast<Eigen::Index>(triangles.size())) = mesh::barycentric(*to_, point).transpose();
      triangles.push_back(point.triangle);
    }
    return {copy(images.vertices), copy(triangles), copy(barycentric), copy(images.residuals.transpose())};
  }

 private:
  SurfacePointer from_, to_;
  forms::RowMajorMatrix from_forms_, to_forms_;
  Execution execution_;
  moduli::Continuation value_;
};

void bind_equivalence(py::module_& m) {
  using moduli::Comparison;
  using moduli::Isometry;
  py::class_<Isometry>(m, "Isometry")
      .def_property_readonly("matrix", [](const Isometry& isometry) { return copy(isometry.matrix); })
      .def_readonly("residual", &Isometry::residual);
  py::class_<Comparison>(m, "Comparison")
      .def_property_readonly("verdict",
                             [](const Comparison& made) { return kVerdicts[static_cast<std::size_t>(made.verdict)]; })
      .def_readonly("isometry", &Comparison::isometry)
      .def_readonly("sign", &Comparison::sign)
      .def_readonly("tolerance", &Comparison::tolerance)
      .def_readonly("margin", &Comparison::margin)
      .def_readonly("is_complete", &Comparison::is_complete);
  py::class_<Images>(m, "Images")
      .def_readonly("vertices", &Images::vertices)
      .def_readonly("triangles", &Images::triangles)
      .def_readonly("barycentric", &Images::barycentric)
      .def_readonly("residuals", &Images::residuals);
  py::class_<moduli::Similarity>(m, "Similarity")
      .def_readonly("dilatation", &moduli::Similarity::dilatation)
      .def_readonly("is_exact", &moduli::Similarity::is_exact);
  py::class_<PeriodLattice>(m, "PeriodLattice")
      .def_static("closed", &moduli::closed_lattice, py::arg("gram"), py::arg("wedge"))
      .def_static("bounded", &moduli::bounded_lattice, py::arg("natural_gram"), py::arg("dirichlet_gram"),
                  py::arg("pairing"), py::arg("genus"))
      .def("projected", &moduli::projected_lattice)
      .def("radius", &moduli::radius);
  py::class_<Continuation>(m, "Continuation")
      .def(py::init<SurfacePointer, forms::RowMajorMatrix, SurfacePointer, forms::RowMajorMatrix>(), py::arg("first"),
           py::arg("first_forms"), py::arg("second"), py::arg("second_forms"))
      .def("run", &Continuation::run, py::arg("vertex"), py::arg("triangle"), py::arg("residual"),
           py::arg("most_vertices"), py::arg("progress"));
  m.def("carried_uv", &carried_uv, py::arg("first"), py::arg("triangles"), py::arg("barycentric"), py::arg("second"),
        py::arg("uv"), py::arg("progress"));
  m.def("map_derivatives", &map_derivatives, py::arg("first"), py::arg("triangles"), py::arg("barycentric"),
        py::arg("second"), py::arg("sign"), py::arg("progress"));
  m.def("form_slopes", &form_slopes, py::arg("surface"), py::arg("forms"));
  m.attr("isometry_steps") = moduli::kMostSteps;
  m.def(
      "short_basis", [](const Eigen::MatrixXd& form) { return copy(moduli::short_basis(form)); }, py::arg("form"));
  m.def("similarity", &similarity, py::arg("first"), py::arg("second"), py::arg("sign"), py::arg("progress"));
  m.def("compare", &compare, py::arg("first"), py::arg("second"), py::arg("allowed"), py::arg("needed"),
        py::arg("progress"));
  m.def("isometries", &isometries, py::arg("first"), py::arg("second"), py::arg("sign"), py::arg("slack"),
        py::arg("progress"));
}

using structure::SideClasses;

// A surface of triangles and lengths that stands for another one, with its errors.
std::shared_ptr<mesh::Surface> refined_surface(int vertex_count, const Contiguous<std::int64_t>& faces,
                                               const Contiguous<double>& lengths,
                                               const Contiguous<std::int64_t>& face_edges,
                                               const Contiguous<double>& errors) {
  const auto f = rows<std::int64_t, 3>(faces), names = rows<std::int64_t, 3>(face_edges);
  const auto l = rows<double, 3>(lengths);
  const auto e = values(errors);
  const py::gil_scoped_release unlocked;
  Execution execution;
  auto surface = std::make_shared<mesh::Surface>(mesh::make_intrinsic_surface(vertex_count, f, l, names, execution));
  surface->metric_errors.assign(e.begin(), e.end());
  return surface;
}

structure::NestedLevel solve_level(const mesh::Surface& surface, const Contiguous<int>& classes, int natural, int order,
                                   int threads, const py::object& progress) {
  Execution execution(threads, callback(progress));
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  const py::gil_scoped_release unlocked;
  return structure::solve_level(surface, given, natural, order, execution);
}

// Energies of forms with these functions, on the Delaunay triangulation of the surface.
structure::CertainGram measure(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                               const forms::RowMajorMatrix& functions) {
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  Execution execution;
  return structure::measure(surface, given, natural, functions, execution);
}

structure::CertainGram measure_level(const mesh::Surface& surface, const Contiguous<int>& classes, int natural,
                                     int order, const forms::RowMajorMatrix& functions) {
  const Eigen::Map<const SideClasses> given(classes.data(), classes.shape(0), classes.shape(1));
  Execution execution;
  return structure::measure_level(surface, given, natural, order, functions, execution);
}

void bind_nested_level(py::module_& m) {
  using structure::CertainGram;
  using structure::NestedLevel;
  py::class_<CertainGram>(m, "CertainGram")
      .def_readonly("gram", &CertainGram::gram)
      .def_readonly("certain", &CertainGram::certain);
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const NestedLevel&>().*member, self); };
  };
  py::class_<NestedLevel>(m, "NestedLevel")
      .def_property_readonly("triangles", viewed(&NestedLevel::triangles))
      .def_property_readonly("triangle_edges", viewed(&NestedLevel::triangle_edges))
      .def_property_readonly("lengths", viewed(&NestedLevel::lengths))
      .def_property_readonly("errors", viewed(&NestedLevel::errors))
      .def_property_readonly("classes", [](const NestedLevel& level) { return copy(level.classes); })
      .def_property_readonly("functions", [](const NestedLevel& level) { return copy(level.functions); })
      .def_readonly("energies", &NestedLevel::energies)
      .def_property_readonly("gaps", viewed(&NestedLevel::gaps))
      .def_readonly("mollification", &NestedLevel::mollification);
  m.def("refined_surface", &refined_surface, py::arg("vertex_count"), py::arg("faces"), py::arg("lengths"),
        py::arg("face_edges"), py::arg("errors"));
  m.def(
      "length_errors", [](const mesh::Surface& surface) { return copy(structure::length_errors(surface)); },
      py::arg("surface"));
  m.def("solve_level", &solve_level, py::arg("surface"), py::arg("classes"), py::arg("natural"), py::arg("order"),
        py::arg("threads"), py::arg("progress"));
  m.def("measure", &measure, py::arg("surface"), py::arg("classes"), py::arg("natural"), py::arg("functions"));
  m.def("measure_level", &measure_level, py::arg("surface"), py::arg("classes"), py::arg("natural"), py::arg("order"),
        py::arg("functions"));
  m.def("element_bytes", &forms::bytes, py::arg("faces"), py::arg("order"), py::arg("forms"));
  m.def(
      "reference_element",
      [](int order) {
        const auto& [p, stiffness, wedge] = forms::reference_element(order);
        return py::make_tuple(copy(stiffness[0]), copy(stiffness[1]), copy(stiffness[2]), copy(wedge));
      },
      py::arg("order"));
}

}  // namespace

void bind_moduli(py::module_& m) {
  bind_equivalence(m);
  bind_nested_level(m);
}

}  // namespace holomorph::bindings
