// The strain of a map on the triangles of a surface, and the energy that weighs shear against size.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "base/page_allocator.h"
#include "base/workers.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

// The energy by which evening weighs the shear of a triangle against its size; see StrainEnergy.

/// #T, for each corner the complex number of modulus 1 by which a function at its vertex is turned there. Across an
/// edge all three of a triangle differ by one turn. Empty: by none.
using CornerTurns = std::vector<std::array<Complex, 3>>;

/// The energy of a triangle of area 1 on which the map is a z + b conj(z). `by_a` and `by_b` are its derivatives by |a|
/// and |b|, divided by |a| and |b|.
struct TriangleEnergy {
  double value, by_a, by_b;
};

/// @param square_a |a|^2, positive. @param square_b |b|^2; larger where the triangle is flipped
/// @param log_size 2 ln s0
TriangleEnergy triangle_energy(double square_a, double square_b, double lambda, double log_size);

/// Returns how much larger the second derivatives are than where the map is conformal and of the mean size.
/// @param ratio |b| / |a|. @param size ln(s1 s2 / s0^2)
double stiffness(double ratio, double size, double lambda);

/// #V, a function u + i v on the vertices.
using Function = Array<Complex>;

/// E(delta) = sum over triangles t of A_t ((1 - lambda) shear^2 + lambda size^2 (1 + c x)), where
/// shear = ln s1 - ln s2 and size = ln s1 + ln s2 - 2 ln s0, for the singular values s1 >= s2 of the map uv + delta.
/// s0 is the mean size of the map without delta. Areas add up to 1. With c = 0 it is the quadratic energy of the
/// logarithmic strain (Neff, Eidel and Martin 2016, doi:10.1007/s00205-016-1007-x). x = size^2 / (1 + size^2 / 2)
/// and c = 1.2 (0.7 - lambda) raise the weight of the few largest and smallest squares, around branch points and poles.
/// The energy is continued as a parabola where s1 / s2 is large and where a triangle is flipped.
///
/// At a pole the map is infinite, and a triangle there stays as it is: its strain is that from the map without delta.
/// Triangles without area do not count.
class StrainEnergy {
 public:
  /// @param uv #C x 2; its jumps across edges are translations, or turns as well. @param poles vertices
  StrainEnergy(const mesh::Surface& surface, const uv::UvArray& uv, const std::vector<int>& poles,
               const CornerTurns& turns, Workers& workers);

  int vertex_count() const { return static_cast<int>(star_starts_.size()) - 1; }

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

  /// Multiplies the weight of the triangles that delta flips, so that a descent turns them back.
  void emphasise_flipped(const Function& delta, Workers& workers);

  /// Returns edge weights of a Laplacian close to the second derivatives. Where the map is conformal, these lie between
  /// 2 (1 - lambda) times it and twice it. Elsewhere it grows with them.
  /// @return #E of the surface
  Array<double> edge_weights(const mesh::Surface& surface, const Function& delta, double lambda) const;
  /// Returns the lower triangle of that Laplacian's matrix on the first `count` vertices. Where functions turn from
  /// corner to corner it is that of their real and imaginary parts, in turn, twice as large.
  Eigen::SparseMatrix<double> laplacian(const Function& delta, double lambda, int count) const;

  struct Patch;  // uv/evening.cpp
  /// Rings of triangles around the flipped ones.
  struct Rings {
    int all, inner;
  };
  /// Returns the connected patches of the triangles that delta flips and `rings.all` rings around them. The
  /// `rings.inner` inner rings keep the shape that the map without delta gives them, and so flip no more than it does;
  /// 0 for none.
  std::vector<Patch> around_flipped(const Function& delta, Rings rings) const;
  /// #V: marks the corners of triangles that delta flips.
  std::vector<char> flipped_corners(const Function& delta) const;
  /// Marks the corners of this number of rings of triangles around the vertices that are marked, #V.
  void grow(std::vector<char>& marked, int rings) const;

 private:
  struct Derivatives {
    Complex a, b;
  };
  struct Triangle {
    mesh::Triple vertices;
    bool at_pole = false, keeps_shape = false, reversed = false;  // whatever its size; reversed in the plane of z
    Complex a, b;  // the map is a z + b conj(z) + constant; z along side 0, at a pole the map itself
    std::array<Complex, 2> gradients;  // gradients of the hat functions of corners 1 and 2
    double area = 0;                   // 0: does not count
    double emphasis = 1;               // by which its part of the energy is multiplied
    double log_size = 0;               // 2 ln of the size that it is to have

    void lay_out(const mesh::Surface& surface, int t, const uv::UvArray& uv);
    void keep_shape(const Derivatives& map);
    double lambda(double given) const { return keeps_shape ? 0 : given; }
  };
  using Turned = std::array<Complex, 2>;  // by which functions at corners 1 and 2 are turned, from corner 0
  static bool flipped(const Triangle& triangle, const Derivatives& map);

  StrainEnergy() = default;
  void find_stars(int vertex_count);
  Turned turned(std::size_t t) const { return turned_.empty() ? Turned{1, 1} : turned_[t]; }
  // Derivatives of the map on triangle t with the function added, and whether that flips it.
  Derivatives derivatives(std::size_t t, const Function& function) const;
  bool flips(std::size_t t, const Function& function) const;
  // The factor of the squared gradient of a change in the second derivatives.
  double stiffness_of(std::size_t t, const Function& delta, double lambda) const;

  double log_size_ = 0;    // 2 ln s0
  double whole_area_ = 1;  // area of the triangles that the mean is over
  Array<Triangle> triangles_;
  Array<Turned> turned_;                         // #T; empty: by none
  std::vector<int> star_starts_, star_corners_;  // at each vertex, 3 t + i where it is corner i of triangle t
};

}  // namespace holomorph::uv
