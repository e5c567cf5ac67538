// The vertices that a pole may go to.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "tiling/greens/pole_basis.h"
#include "tiling/poles/meromorphic_form.h"

namespace holomorph::tiling {

/// The most even form without poles, by every how many samples.
struct BalancedForm {
  int every = 0;  ///< 0: not known yet
  MeromorphicForm form;
};

/// Where the search may place poles.
struct PlaceOptions {
  uv::Coefficients kind = uv::Coefficients::complex;
  std::vector<char> allowed;                         ///< #V of the basis: may a pole be there; empty: anywhere
  std::vector<int> fixed;                            ///< poles that stay where they are
  std::vector<std::vector<int>> polygons = {};       ///< sets of vertices that, like a face, have room for one pole
  bool evened = false;                               ///< the number of poles is to be enough for an evened map
  std::shared_ptr<BalancedForm> balanced = nullptr;  ///< filled where it is needed and not known
};

/// Vertices are candidates where a pole is allowed, its star is apart from those of the other poles, and it is not too
/// near to them.
class PoleCandidates {
 public:
  /// @pre both outlive this
  PoleCandidates(const PoleBasis& basis, const PlaceOptions& options);

  /// Returns the first poles of a surface without forms: two far apart on a closed surface, one deep inside a disk.
  /// @throws TopologyError if there is no room
  std::vector<int> first();
  /// Returns some 200 candidates all over the surface, ascending. @param others the poles of the form besides
  std::vector<int> everywhere(const std::vector<int>& others);
  /// Returns such candidates, and more of them near `vertex`, without `vertex` itself; ascending.
  std::vector<int> for_move(int vertex, const std::vector<int>& others);

 private:
  std::vector<int> first_candidates();
  std::vector<int> spread() const;
  std::vector<int> near(int vertex);
  std::vector<int> free_ones(std::vector<int> candidates, const std::vector<int>& others);
  const std::vector<double>& distances(int vertex);
  bool is_allowed(int vertex) const {
    return (options_.allowed.empty() || options_.allowed[vertex]) && basis_.is_certain(vertex);
  }

  const PoleBasis& basis_;
  const PlaceOptions& options_;
  std::map<int, std::vector<int>> polygons_at_;   // by vertex
  std::map<int, std::vector<double>> distances_;  // along edges, from all poles so far
};

}  // namespace holomorph::tiling
