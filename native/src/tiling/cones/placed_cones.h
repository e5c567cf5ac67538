// Cones on a surface, and the maps around them: the nearest whole numbers, evened, and what is wrong with them.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/execution.h"
#include "tiling/cones/cones.h"
#include "tiling/cones/lattice_map.h"
#include "tiling/cones/lines.h"
#include "tiling/cones/rounding.h"
#include "tiling/cones/turned_space.h"
#include "uv/evening.h"
#include "uv/turned_functions.h"
#include "uv/uv_map.h"

namespace holomorph::tiling {

/// Cones on a surface, and what the maps with these have in common, whatever their tiles and evenness.
class PlacedCones {
 public:
  /// Frames, and the space of the maps with these cones. @param missing #V, as in Cones
  /// @throws SolverError, Cancelled, as all below
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, std::vector<int> missing,
              Execution& execution);
  /// The cones and frames of a field that runs along lines.
  PlacedCones(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, const Lines& lines,
              Execution& execution);

  struct Judged {
    LatticeMap map;
    uv::UvArray before;  ///< #C x 2, in the plane, before it was evened
    /// The wrong area, and the energy as in uv/evening.h with that of rows that are not level.
    std::pair<double, double> bad{kInfinity, 0};
  };
  /// The best of the maps by so many of the nearest whole numbers.
  Judged best_map(double tiles, double evenness, int tries, const uv::EveningOptions& options,
                  Execution& execution) const;
  const std::vector<int>& missing() const { return missing_; }  ///< #V, of the cones
  const TurnLattice& lattice() const { return space_.lattice; }

 private:
  std::vector<NearestMap::Rounded> nearest(double tiles) const;
  LatticeMap map(const Eigen::VectorXcd& y, const NearestMap::Rounded& rounded) const;
  uv::UvArray laid(const LatticeMap& map) const;
  // The frames turned as one to be level, with those that are pulled.
  Frames levelled(Frames frames, const ConeOptions& options) const;
  // The strain of a map in the plane, with what is minded of rows that are not level.
  double strain(const uv::UvArray& laid, double evenness, Execution& execution) const;
  Eigen::VectorXcd evened(Eigen::VectorXcd y, const NearestMap::Rounded& rounded, double evenness,
                          const uv::EveningOptions& options, Execution& execution) const;
  uv::Kept kept() const;

  std::shared_ptr<const mesh::Surface> surface_;
  Net net_;
  std::vector<int> missing_;
  Frames frames_;
  TurnedSpace space_;
  NearestMap nearest_;
  std::optional<Along> along_;
};

}  // namespace holomorph::tiling
