// The strain of a map on the triangles of a surface, and the energy that weighs shear against size.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::evening {

using Complex = std::complex<double>;

/// #V, a function u + i v on the vertices.
using Function = Array<Complex>;

/// E(delta) = sum over triangles t of A_t ((1 - lambda) shear^2 + lambda size^2), where shear = ln s1 - ln s2 and
/// size = ln s1 + ln s2 - 2 ln s0, for the singular values s1 >= s2 of the map uv + delta: the quadratic energy of the
/// logarithmic strain (Neff, Eidel and Martin 2016, doi:10.1007/s00205-016-1007-x), which goes on as a parabola where
/// s1 / s2 is large and where a triangle is flipped. s0 is the mean size of the map without delta. Areas add up to 1.
///
/// At a pole the map is infinite, and a triangle there stays as it is: its strain is that from the map without delta.
/// Triangles without area do not count.
class StrainEnergy {
 public:
  /// @param uv #C x 2; its jumps across edges are translations, so that its derivatives are one on each triangle
  /// @param poles vertices. @pre the surface outlives this
  StrainEnergy(const mesh::Surface& surface, const uv::UvArray& uv, const std::vector<int>& poles, Workers& workers);

  int vertex_count() const { return surface_.vertex_count; }

  struct Value {
    double energy = 0, flipped = 0;  ///< E, and the area that is flipped
    Value& operator+=(const Value& other) {
      energy += other.energy;
      flipped += other.flipped;
      return *this;
    }
  };

  /// E and dE/du + i dE/dv at each vertex.
  /// @param at_corners memory, the same from one call to the next
  Value operator()(const Function& delta, double lambda, Function& gradient, Function& at_corners,
                   Workers& workers) const;

  /// Makes triangles count more that are flipped by delta.
  void emphasise_flipped(const Function& delta, Workers& workers);

  /// #E, the weights of a Laplacian: the cotangent weights of each triangle over the determinant of the map. The
  /// second derivatives of E where the map is conformal lie between 2 (1 - lambda) times this Laplacian and twice it.
  Array<double> weights(const Function& delta, double lambda) const;

 private:
  struct Triangle {
    Complex a, b;  // the map is a z + b conj(z) + constant; z along side 0, at a pole the map itself
    std::array<Complex, 2> gradients;  // gradients of the hat functions of corners 1 and 2
    double area = 0;                   // 0: does not count
    double emphasis = 1;               // by which its part of the energy is multiplied
    bool at_pole = false;
  };
  struct Derivatives {
    Complex a, b;
  };
  double log_size(const Triangle& triangle) const { return triangle.at_pole ? 0 : log_size_; }
  Derivatives derivatives(int triangle, const Function& function) const;

  const mesh::Surface& surface_;
  double area_ = 1;      // of the triangles that count
  double log_size_ = 0;  // 2 ln s0
  Array<Triangle> triangles_;
  std::vector<int> star_starts_, star_corners_;  // of each vertex: 3 t + i where it is corner i of triangle t
};

}  // namespace holomorph::evening
