// The vertices that a pole may go to.
#pragma once

#include <map>
#include <vector>

#include "tiling/poles/mirror.h"

namespace holomorph::tiling {

/// Where the search may place poles.
struct PlaceOptions {
  uv::Coefficients kind = uv::Coefficients::complex;
  std::vector<char> allowed;                    ///< #V of the basis: may a pole be there; empty: anywhere
  std::vector<int> fixed;                       ///< poles that stay where they are
  std::vector<std::vector<int>> polygons = {};  ///< vertices of which one may be a pole, beside faces of the surface
  const Mirror* mirror = nullptr;               ///< poles lie as it says
  bool evened = false;                          ///< the number of poles is to do for an evened map
};

/// Vertices are candidates where a pole is allowed, its star is apart from those of the other poles, and it is not too
/// near to them.
class PoleCandidates {
 public:
  /// @pre both outlive this
  PoleCandidates(const PoleBasis& basis, const PlaceOptions& options);

  /// Where a surface without forms has its first poles: two far apart on a closed one, one deep inside another.
  /// @throws TopologyError if there is no room
  std::vector<int> first();
  /// Some 200 all over the surface, ascending.
  std::vector<int> everywhere(const std::vector<int>& others);
  /// Those, and some around `vertex`, the more the nearer, which is none of them; ascending. With a mirror all are
  /// on the plane, or none, as the vertex is.
  std::vector<int> for_move(int vertex, const std::vector<int>& others);

 private:
  std::vector<int> first_candidates();
  std::vector<int> spread() const;
  std::vector<int> near(int vertex);
  std::vector<int> first_mirrored();
  std::vector<int> free_ones(std::vector<int> candidates, const std::vector<int>& others);
  bool is_apart_from_image(int vertex, const std::vector<char>& taken) const;
  bool may_replace(int vertex, int by) const;
  const std::vector<double>& distances(int vertex);
  bool is_allowed(int vertex) const {
    return (options_.allowed.empty() || options_.allowed[vertex]) && basis_.is_certain(vertex) &&
           (!options_.mirror || options_.mirror->image[vertex] >= 0);
  }

  const PoleBasis& basis_;
  const PlaceOptions& options_;
  std::map<int, std::vector<int>> polygons_at_;   // by vertex
  std::map<int, std::vector<double>> distances_;  // along edges, from poles there have been
};

}  // namespace holomorph::tiling
