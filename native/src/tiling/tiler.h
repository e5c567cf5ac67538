// Seamless tilings: poles for even density, periods on the texture's lattice, nothing left over.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "structure/options.h"
#include "structure/structure.h"
#include "tiling/abel_jacobi.h"
#include "tiling/candidate.h"
#include "tiling/closed_maps.h"
#include "tiling/coarse_level.h"
#include "tiling/moved_poles.h"
#include "tiling/pole_moves.h"
#include "tiling/poles.h"
#include "tiling/rounding.h"

namespace holomorph::tiling {

struct PoleWishes {
  std::optional<int> count;   ///< none: as many as the density asks for
  std::vector<int> vertices;  ///< chosen ones, which stay where they are
  std::vector<char> allowed;  ///< #V: where others may be; empty: anywhere
};

struct TilingWishes {
  double tiles = 0;  ///< over the surface at its median density; 0: a number that suits it
  TextureLattice lattice;
  std::optional<std::array<double, 3>> direction;  ///< in space, along which u runs as far as it can
  std::optional<double> turn;                      ///< by which the texture is rotated beside that, in radians
  double most_turn = 0.2;                          ///< by how much the rounding may turn away from these
};

/// A map whose jumps all are translations of the texture.
struct Tiling {
  std::shared_ptr<const structure::Structure> structure;  ///< with the poles, its forms and its cut
  std::vector<int> poles;
  std::vector<std::complex<double>> residues;
  Eigen::VectorXcd periods;  ///< over the homology basis of the structure
  double tiles = 0;          ///< as wished, or the number that suits
  double distortion = 1;     ///< by the rounding alone: mean s1 / s2
  double left_over = 0;      ///< root mean square of |mu|
  uv::UvArray uv;            ///< #C x 2
};

class Tiler {
 public:
  /// @param straight whether boundary loops become lines of constant v; they do in any case beside handles, where free
  /// ones would leave more over
  /// @param names what a vertex is called in messages; empty: its index
  /// @pre connected, no isolated vertices
  Tiler(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, bool straight,
        std::vector<int> names);

  /// Places the poles, on a level of the progressive mesh where the surface is large.
  /// @throws TopologyError for poles that do not fit; SolverError; Cancelled
  void place(const PoleWishes& wishes, Execution& execution);

  const Poles& poles() const { return poles_; }
  /// 95 % over 5 % quantile of the density that the poles allow without rounding.
  double optimal_density_ratio() const { return optimum_; }

  /// @pre placed. @throws TopologyError where nothing with that few tiles is seamless; SolverError; Cancelled
  Tiling tile(const TilingWishes& wishes, Execution& execution);

  /// The last tiling that `tile` made with some of its poles elsewhere (moved_poles.h). Nothing is rounded: quick.
  /// @pre tiled. @throws TopologyError for poles that do not fit; SolverError; Cancelled
  Tiling with_poles_moved(const std::vector<PoleMove>& moves, Execution& execution);

 private:
  bool has_leverage() const { return pole_moves_ != nullptr; }
  void adopt(std::unique_ptr<Landscape> landscape, Poles poles, Execution& execution);
  void transfer(std::unique_ptr<Landscape> on_level, const CoarseLevel& level, Poles poles, Execution& execution);
  std::shared_ptr<structure::Structure> structure_at(const std::vector<int>& vertices, Execution& execution);
  Eigen::MatrixXd parts(PlacedPoles& placed, Execution& execution);
  RoundingWishes rounding_wishes(const TilingWishes& wishes, Execution& execution);
  Tiling map_of(const Candidate& candidate, Execution& execution);
  void write_map(Tiling& result, const Eigen::VectorXcd& X, const TextureLattice& lattice, Execution& execution);

  std::shared_ptr<const mesh::Surface> surface_;
  structure::Options options_;
  uv::Coefficients kind_;
  std::vector<int> names_;
  std::unique_ptr<Landscape> landscape_;
  std::unique_ptr<AbelJacobi> abel_jacobi_;  // only on a closed surface with handles
  std::unique_ptr<PoleMoves> pole_moves_;    // the same
  Poles poles_;
  std::vector<char> allowed_;  // #V, where poles may go; empty: anywhere
  bool chosen_ = false;        // the poles were chosen, and stay
  double optimum_ = 1;
  std::shared_ptr<structure::Structure> structure_;  // at structure_poles_, kept for the next tiling
  std::vector<int> structure_poles_;
  std::shared_ptr<ClosedMaps> closed_maps_;  // the same on a closed surface with poles
  std::optional<Choice> last_;               // what the last tiling was made of
};

}  // namespace holomorph::tiling
