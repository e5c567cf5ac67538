#include "plane/disk_map.h"

#include <numbers>

#include "base/finite.h"

namespace holomorph::plane {
namespace {

constexpr double kRounding = 1e-12;  // what |z| may be off on the boundary

}  // namespace

Eigen::VectorXcd disk_map(const structure::Structure& s, const uv::UvArray& function, Workers& workers) {
  const Eigen::VectorXcd at_vertex = function.col(0) + std::complex<double>(0, 1) * function.col(1);
  Eigen::VectorXcd z = (std::complex<double>(0, 2 * std::numbers::pi) * at_vertex.array()).exp();
  z[s.stars()[0].vertex] = 0;
  // v >= 0 in the disk, but on coarse meshes the discrete function may be negative inside.
  z = (z.array().abs() > 1 + kRounding).select(z.array() / z.array().abs(), z);
  require_finite(z, "vertex", workers);
  return z;
}

}  // namespace holomorph::plane
