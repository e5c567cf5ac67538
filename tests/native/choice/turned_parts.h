// Parts that are turned about the vertical, for the tests.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "choice/part.h"

namespace holomorph::choice {

/// Radius and height of a ring.
using Ring = std::array<double, 2>;

/// Rings one above the other, of n quads each, or of triangles to a tip where a radius is 0.
/// @param is_round the last ring is followed by the first, as on a torus. @param is_there (ring, quad): others are left
/// out. @param factor of each position
PartPointer turned_part(const std::vector<Ring>& rings, int n, bool is_round = false,
                        const std::function<bool(int, int)>& is_there = {},
                        const std::function<double(const std::array<double, 3>&)>& factor = {});

PartPointer tube(int rings, int n, const std::function<bool(int, int)>& is_there = {});
PartPointer torus(int n, int m);
/// A ball with a long limb on its top: poles at both ends are enough for it.
PartPointer limb();

/// The polygons of a mesh as a part. @param faces vertices of each
PartPointer part_of_faces(std::vector<std::array<double, 3>> vertices, const std::vector<std::vector<int>>& faces);

}  // namespace holomorph::choice
