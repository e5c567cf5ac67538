// Vector fields in space, as forms on the triangles of a surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::uv {

/// 3 x #triangles: e_x + i e_y of the plane of each triangle, x along side 0. The form A dz is the field A (e_x + i
/// e_y), gradient of u plus i times gradient of v. @pre the surface has positions
Eigen::MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles);

/// #triangles x count: A of |A| = 1, with gradient u along smooth fields in space. They are fixed beside the surface's
/// bounding box: whatever its numbering is they are the same. @pre the surface has positions
Eigen::MatrixXcd even_fields(const mesh::Surface& surface, const std::vector<int>& triangles, int count);

}  // namespace holomorph::uv
