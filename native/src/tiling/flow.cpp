#include "tiling/flow.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <limits>

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles) {
  MatrixXcd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) {
    const auto corner = [&](int i) {
      const auto& position = surface.polygons.vertices[surface.triangles[triangles[s]][i]];
      return Eigen::Vector3d(position[0], position[1], position[2]);
    };
    const Eigen::Vector3d x = (corner(1) - corner(0)).stableNormalized();
    const Eigen::Vector3d along2 = corner(2) - corner(0);
    const Eigen::Vector3d y = (along2 - along2.dot(x) * x).stableNormalized();
    result.col(s) = x.cast<Complex>() + Complex(0, 1) * y.cast<Complex>();
  }
  return result;
}

double phase_along(const std::array<double, 3>& axis, const MatrixXcd& frames, const VectorXcd& A) {
  const Eigen::RowVector3cd direction = Eigen::RowVector3d(axis[0], axis[1], axis[2]).cast<Complex>();
  const Eigen::ArrayXcd along = (direction * frames).transpose().array() * A.array() /
                                A.array().abs().max(std::numeric_limits<double>::min()).cast<Complex>();
  const Complex turn = std::polar(1.0, -std::arg(along.square().sum()) / 2);
  return std::arg((turn * along.sum()).real() < 0 ? -turn : turn);
}

VectorXcd fitted_coefficients(const VectorXcd& wanted, const MatrixXcd& wanted_frames, const MatrixXcd& forms,
                              const VectorXcd& known, const MatrixXcd& frames, bool real) {
  MatrixXcd rows(3 * wanted.size(), forms.cols());
  VectorXcd right(3 * wanted.size());
  for (Index s = 0; s < wanted.size(); ++s) {
    const double weight = 1 / (std::abs(wanted[s]) + std::numeric_limits<double>::min());
    rows.middleRows(3 * s, 3) = weight * frames.col(s) * forms.row(s);
    right.segment(3 * s, 3) = weight * (wanted[s] * wanted_frames.col(s) - known[s] * frames.col(s));
  }
  const MatrixXcd gram = rows.adjoint() * rows;
  const VectorXcd moments = rows.adjoint() * right;
  if (real) return gram.real().ldlt().solve(moments.real()).cast<Complex>();
  return gram.ldlt().solve(moments);
}

}  // namespace holomorph::tiling
