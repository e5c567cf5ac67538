#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "moduli/carried_uv.h"
#include "moduli/continuation.h"
#include "moduli/equivalence.h"

namespace holomorph::bindings {
namespace {

using moduli::PeriodLattice;
using SurfacePointer = std::shared_ptr<mesh::Surface>;

py::tuple as_tuple(const moduli::Isometry& isometry) {
  return py::make_tuple(copy(isometry.matrix), isometry.residual, isometry.excess);
}

py::tuple compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, const py::object& progress) {
  Execution execution(1, callback(progress));
  moduli::Comparison made;
  {
    const py::gil_scoped_release unlocked;
    made = moduli::compare(a, b, allowed, moduli::kMostSteps, execution);
  }
  const py::object isometry = made.isometry ? py::object(as_tuple(*made.isometry)) : py::none();
  return py::make_tuple(static_cast<int>(made.verdict), isometry, made.sign, made.tolerance, made.margin,
                        made.is_complete);
}

py::tuple isometries(const PeriodLattice& a, const PeriodLattice& b, int sign, double slack,
                     const py::object& progress) {
  Execution execution(1, callback(progress));
  moduli::Isometries made;
  {
    const py::gil_scoped_release unlocked;
    made = moduli::isometries(a, b, {sign, slack}, execution);
  }
  py::list found;
  for (const auto& isometry : made.found) found.append(as_tuple(isometry));
  return py::make_tuple(found, made.is_complete);
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

// Of (#V,) triangles and (#V, 3) barycentric coordinates, and (#C', 2) UVs: (#C, 2).
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

/// A continuation that keeps what it is made of.
class Continuation {
 public:
  Continuation(SurfacePointer from, forms::RowMajorMatrix from_forms, SurfacePointer to, forms::RowMajorMatrix to_forms)
      : from_(std::move(from)),
        to_(std::move(to)),
        from_forms_(std::move(from_forms)),
        to_forms_(std::move(to_forms)),
        value_({*from_, from_forms_}, {*to_, to_forms_}, execution_) {}

  // From a vertex whose image is in the middle of a triangle: vertices, triangles, barycentric coordinates, residuals.
  py::tuple run(int vertex, int triangle, const Eigen::VectorXd& residual, std::size_t most_vertices,
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
    return py::make_tuple(copy(images.vertices), copy(triangles), copy(barycentric),
                          copy(images.residuals.transpose()));
  }

 private:
  SurfacePointer from_, to_;
  forms::RowMajorMatrix from_forms_, to_forms_;
  Execution execution_;
  moduli::Continuation value_;
};

}  // namespace

void bind_moduli(py::module_& m) {
  py::class_<PeriodLattice>(m, "PeriodLattice")
      .def_static("closed", &moduli::closed_lattice)
      .def_static("bounded", &moduli::bounded_lattice)
      .def("projected", &moduli::projected_lattice)
      .def("radius", &moduli::radius);
  py::class_<Continuation>(m, "Continuation")
      .def(py::init<SurfacePointer, forms::RowMajorMatrix, SurfacePointer, forms::RowMajorMatrix>())
      .def("run", &Continuation::run);
  m.def("carried_uv", &carried_uv);
  m.def("form_slopes", &form_slopes);
  m.attr("isometry_steps") = moduli::kMostSteps;
  m.def("short_basis", [](const Eigen::MatrixXd& form) { return copy(moduli::short_basis(form)); });
  m.def("compare", &compare);
  m.def("isometries", &isometries);
}

}  // namespace holomorph::bindings
