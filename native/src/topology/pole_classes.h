// Integer classes of a surface without the stars of its poles.
#pragma once

#include "topology/domain.h"
#include "topology/integer_forms.h"

namespace holomorph::topology {

/// Counts the signed crossings of dual paths through D, each from the face of a star's link[0]. A class has the period
/// +1 counter-clockwise around its star. It is closed on every face outside the stars, and 0 on all spokes and on all
/// link edges but link[0]. A closed surface has one class for each star but the last, with the period -1 around the
/// last, where the path ends. With boundary there is one for each star, and its path leaves through the gap of boundary
/// loop 0.
/// @param domain made with these stars
IntegerForms pole_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                          const std::vector<mesh::Star>& stars);

}  // namespace holomorph::topology
