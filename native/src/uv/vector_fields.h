// Vector fields in space, as forms on the triangles of a surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::uv {

/// Returns e_x + i e_y of the plane of each triangle, 3 x #triangles, x along side 0. The form A dz is the field A (e_x
/// + i e_y), gradient of u plus i times gradient of v. @pre the surface has positions
Eigen::MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles);

/// Returns A with |A| = 1, #triangles x count, whose gradient of u runs along smooth fields in space. The fields are
/// fixed relative to the bounding box, so they do not depend on the surface's numbering. @pre the surface has positions
Eigen::MatrixXcd even_fields(const mesh::Surface& surface, const std::vector<int>& triangles, int count);

}  // namespace holomorph::uv
