// Integer classes of a surface without the stars of its punctures.
#pragma once

#include "topology/fundamental_domain.h"
#include "topology/integer_forms.h"

namespace holomorph::topology {

/// One class for each star but the last: +1 counter-clockwise around its star, -1 around the last one, 0 around the
/// others. It counts the signed crossings of the dual path through D from the face of the star's link[0] to that of the
/// last star's; closed on every face outside the stars, 0 on all spokes, and on the link edges but link[0].
/// @param domain made with these stars, of a closed surface
IntegerForms puncture_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                              const std::vector<mesh::Star>& stars);

}  // namespace holomorph::topology
