// Which way is up on a map: how a texture is turned on the steep part of a surface.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// The axis of the positions that points up.
enum class Up { kY = 1, kZ = 2 };

struct Direction {
  /// #T degrees between the gradient of v and what is up on the triangle, up to 180; for a texture that looks the same
  /// after k-th parts of a full turn, to the nearest of these
  Array<double> angle;
  Array<double> steep;  ///< #T area of each triangle that is steep, so that something is up on it; 0 of others
  double area = 0;      ///< of all triangles
  int turns = 1;        ///< k; 1 where the texture has an up
};

/// Measures a UV map. @param uv #C x 2. @pre the surface has positions. Cost: O(#T)
Direction direction(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Up up, int turns,
                    Workers& workers);

/// The same map under a texture that looks the same after k-th parts of a full turn.
Direction under(Direction direction, int turns);

/// That of several maps together, the triangles of one after those of the other. @param parts at least one
Direction joined(const std::vector<const Direction*>& parts);

/// The gradient in the plane u + i v of the coordinate along an axis in space, on a triangle, times its area in the
/// plane, negative where that is flipped.
std::complex<double> uphill(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, int triangle,
                            const std::array<double, 3>& axis);

struct TriangleTurn {
  double angle;  ///< degrees between the gradient of v and what is up
  double area;
  bool is_steep;  ///< and v has a gradient
};

/// @param v at the corners
TriangleTurn triangle_turn(const std::array<std::array<double, 3>, 3>& points, const std::array<double, 3>& v, Up up);

}  // namespace holomorph::uv
