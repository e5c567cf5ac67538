// The singular part of a differential of the third kind in the stars of its poles.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "base/page_allocator.h"
#include "mesh/stars.h"

namespace holomorph::forms {

/// Near a pole of residue 1 and total angle Theta, in polar coordinates (r, alpha) of its star, u_s = alpha/Theta
/// and v_s = -log(r)/Theta: u_s + i v_s = 1 / (2 pi i) log z with z = (r e^(i alpha))^(2 pi/Theta).
///
/// b_u, b_v are the fluxes of u_s, v_s out of the star through its link, tested with the hat functions. They contain a
/// second term, which makes the result second order: the difference between u_s, v_s and their linear interpolants on
/// the straight link edges, tested with the normal derivatives of the hat functions. Each column of b_u sums to 0,
/// each of b_v to 1; both test linear functions exactly.
struct StarPart {
  std::vector<double> u, v;      ///< at the end of each link edge; u jumps by 1 at link[0]
  std::vector<double> b_u, b_v;  ///< the same
  double b_u_at_pole = 0, b_v_at_pole = 0;
};

/// @param lengths #E
StarPart star_part(const mesh::HalfEdges& half_edges, std::span<const double> lengths, const mesh::Star& star);

/// The parts of several stars, as columns.
struct SingularPart {
  Eigen::SparseMatrix<double> u, v;      ///< #V x #stars, supported on the links; u jumps by 1 at the link edge link[0]
  Eigen::SparseMatrix<double> b_u, b_v;  ///< #V x #stars, supported on the stars
};

/// @param lengths #E
SingularPart singular_part(const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                           const std::vector<mesh::Star>& stars);

/// Returns the weights k over the faces outside the stars: 0 on spokes; on link edges, the part of the outer face.
Array<double> outer_weights(const mesh::HalfEdges& half_edges, std::span<const double> lengths, Array<double> weights,
                            const std::vector<mesh::Star>& stars);

}  // namespace holomorph::forms
