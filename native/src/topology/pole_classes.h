// Integer classes of a surface without the stars of its poles.
#pragma once

#include "topology/domain.h"
#include "topology/integer_forms.h"

namespace holomorph::topology {

/// The signed crossings of dual paths through D, each from the face of a star's link[0]: +1 counter-clockwise around
/// that star. Closed on every face outside the stars; 0 on all spokes and on the link edges but link[0]. Closed
/// surface: one class for each star but the last, -1 around the last, where its path ends. With boundary: one for each
/// star, its path leaves through the gap of boundary loop 0.
/// @param domain made with these stars
IntegerForms pole_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                          const std::vector<mesh::Star>& stars);

}  // namespace holomorph::topology
