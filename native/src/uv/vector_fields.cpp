#include "uv/vector_fields.h"

#include <Eigen/Geometry>
#include <complex>
#include <limits>
#include <random>

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXcd;
using Eigen::Vector3d;

Vector3d position(const mesh::Surface& surface, int triangle, int corner) {
  const auto& p = surface.polygons.vertices[surface.triangles[triangle][corner]];
  return {p[0], p[1], p[2]};
}

// The triangles' centres, in the box of them all from -1 to 1.
Matrix3Xd centres(const mesh::Surface& surface, const std::vector<int>& triangles) {
  Matrix3Xd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) {
    const int t = triangles[s];
    result.col(s) = (position(surface, t, 0) + position(surface, t, 1) + position(surface, t, 2)) / 3;
  }
  const Vector3d low = result.rowwise().minCoeff(), high = result.rowwise().maxCoeff();
  const double half = (high - low).maxCoeff() / 2;
  return (result.colwise() - (low + high) / 2) / std::max(half, std::numeric_limits<double>::min());
}

// A constant along each axis, a rotation about each, and from then on waves.
Matrix3Xd field(const Matrix3Xd& at, int which, std::mt19937_64& numbers) {
  const Vector3d axis = Vector3d::Unit(which % 3);
  if (which < 3) return axis.replicate(1, at.cols());
  if (which < 6) return at.colwise().cross(axis);
  // One number in [-1, 1) from each draw: the standard's distributions differ between libraries.
  const auto vector = [&] {
    Vector3d v;
    for (double& x : v) x = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
    return v;
  };
  const Vector3d a = vector(), b = vector(), wave = 3 * vector();
  const Eigen::RowVectorXd phase = wave.transpose() * at;
  return a * phase.array().cos().matrix() + b * phase.array().sin().matrix();
}

}  // namespace

MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles) {
  MatrixXcd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) {
    const Vector3d origin = position(surface, triangles[s], 0);
    const Vector3d x = (position(surface, triangles[s], 1) - origin).stableNormalized();
    const Vector3d along2 = position(surface, triangles[s], 2) - origin;
    const Vector3d y = (along2 - along2.dot(x) * x).stableNormalized();
    result.col(s) = x.cast<Complex>() + Complex(0, 1) * y.cast<Complex>();
  }
  return result;
}

MatrixXcd even_fields(const mesh::Surface& surface, const std::vector<int>& triangles, int count) {
  const MatrixXcd frames = tangent_frames(surface, triangles);
  const Matrix3Xd at = centres(surface, triangles);
  MatrixXcd result(frames.cols(), count);
  std::mt19937_64 numbers(1);
  for (int i = 0; i < count; ++i) {
    const Matrix3Xd direction = field(at, i, numbers);
    // The field's components in the frame: A (e_x + i e_y) has the gradient of u along its tangential part.
    const Eigen::ArrayXcd A = frames.conjugate().cwiseProduct(direction.cast<Complex>()).colwise().sum().transpose();
    result.col(i) = A / (A.abs() + std::numeric_limits<double>::min());
  }
  return result;
}

}  // namespace holomorph::uv
