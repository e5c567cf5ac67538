// Seamless tilings: poles for even density, integer periods, no other jumps.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "structure/options.h"
#include "structure/structure.h"
#include "tiling/abel_jacobi.h"
#include "tiling/pole_moves.h"
#include "tiling/pole_placement.h"
#include "tiling/rounding.h"

namespace holomorph::tiling {

struct PoleWishes {
  std::optional<int> count;   ///< none: as many as the density asks for
  std::vector<int> vertices;  ///< chosen ones, which stay where they are
  std::vector<char> allowed;  ///< #V: where others may be; empty: anywhere
};

struct TilingWishes {
  double tiles = 0;                        ///< over the surface at its median density; 0: a number that suits it
  TextureLattice lattice;
  std::optional<double> phase;             ///< radians, beside the direction
  double turn = 0.2;  ///< by which a wished phase may change, in radians
  std::optional<std::array<double, 3>> direction;  ///< in space, along which u runs as far as it can
};

/// A map whose jumps all are translations of the texture.
struct Tiling {
  std::shared_ptr<const structure::Structure> structure;  ///< with the poles, its forms and its cut
  Eigen::VectorXcd coefficients;                          ///< of the harmonic forms
  std::vector<int> poles;
  std::vector<std::complex<double>> residues;
  Eigen::VectorXcd periods;  ///< over the homology basis of the structure
  double tiles = 0;          ///< as they were wanted
  double distortion = 1;     ///< by the rounding alone: mean s1 / s2
  double left_over = 0;      ///< root mean square of |mu|
  uv::UvArray uv;            ///< #C x 2
};

class Tiler {
 public:
  /// @param straight whether boundary loops become straight horizontal lines; else they are free
  /// @param names what a vertex is called in messages; empty: its index
  Tiler(std::shared_ptr<const mesh::Surface> surface, const structure::Options& options, bool straight,
        std::vector<int> names, Execution& execution);

  /// Places the poles, on a level of the progressive mesh where the surface is large.
  void place(const PoleWishes& wishes, Execution& execution);

  /// The poles that were placed.
  const Poles& poles() const { return poles_; }
  /// 95 % over 5 % quantile of the density that the poles alone would allow.
  double optimal_density_ratio() const { return optimum_; }

  /// @throws TopologyError where nothing with that few tiles is seamless
  Tiling tile(const TilingWishes& wishes, Execution& execution);

 private:
  bool moves() const { return landscape_->closed() && landscape_->form_count() > 0; }
  void transfer(Landscape& level, const std::vector<int>& vertex, Poles poles, Execution& execution);
  RoundingProblem problem(const TextureLattice& lattice, const Eigen::MatrixXd& parts, Execution& execution);
  std::shared_ptr<structure::Structure> structure_at(const std::vector<int>& vertices, Execution& execution);
  Eigen::MatrixXd parts_of(const structure::Structure& s) const;
  double phase_along(const std::array<double, 3>& direction, Execution& execution);

  std::shared_ptr<const mesh::Surface> surface_;
  structure::Options options_;
  uv::Coefficients kind_;
  std::vector<int> names_;
  std::unique_ptr<Landscape> landscape_;
  std::unique_ptr<AbelJacobi> abel_jacobi_;
  std::unique_ptr<PoleMoves> pole_moves_;
  Poles poles_;
  bool fixed_ = false;  // poles were chosen, and do not move
  double optimum_ = 1;
  std::shared_ptr<structure::Structure> structure_;  // at structure_poles_, kept for the next tiling
  std::vector<int> structure_poles_;
};

}  // namespace holomorph::tiling
