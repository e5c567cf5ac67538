// How the pieces of a surface that is cut are flattened, and laid edge to edge as a paper net.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/execution.h"
#include "flat/island_cuts.h"
#include "mesh/surface.h"
#include "uv/quality.h"

namespace holomorph::flat {

/// A map as it lies in the plane. In islands that lie beside each other a unit of length on the surface is a UV unit.
struct Layout {
  uv::UvArray uv;                 ///< #C x 2
  uv::Quality quality;            ///< also of how far islands lie over themselves
  std::vector<mesh::Pair> seams;  ///< vertices of the edges where the UVs jump
  double soft_length = 0;         ///< of the seams across the smooth, over the square root of the surface's area
  double hard_length = 0;         ///< of those along hard edges that hide them, likewise
  double evenness = 0;            ///< from 0, conformal, to 1
  int islands = 0;                ///< how many there are; 0 for a map of another kind

  double cost() const;
  double seam_cost() const;
  double overlap_cost() const;
};

/// The lengths of seams across the smooth and along hard edges, over the root of the area. @param breaks, is_seam #E
std::pair<double, double> visible_lengths(const mesh::Surface& surface, double area, const std::vector<double>& breaks,
                                          const std::vector<char>& is_seam);

/// What islands are made of.
struct Sheet {
  mesh::Surface surface;       ///< its polygons all read in one direction
  std::vector<double> breaks;  ///< #E, mesh/hard_edges.h
  double area = 0;
  uv::Up up = uv::Up::kZ;
  bool is_upright = true;  ///< whether pieces are to stay so
};

/// A surface that is cut, its pieces, and their conformal maps with free boundaries.
class Flattened {
 public:
  /// Nothing where a piece cannot be flattened, as where it is closed. The sheet outlives this. @throws Cancelled
  static std::optional<Flattened> of(const Sheet& sheet, const Cuts& cuts, Execution& execution);

  const Cuts& cuts() const { return cuts_; }
  const mesh::Surface& pieces() const { return pieces_; }
  const Flattening& flat() const { return flat_; }

  /// #C of the pieces x 2 UVs, each piece for itself.
  uv::UvArray evened(double evenness, Execution& execution) const;

  /// Lays out the UVs by `evened`. @param conformal those for evenness 0, if it is another one
  /// @param joins whether pieces that fit edge to edge are joined
  Layout laid_out(const uv::UvArray& flat_uv, double evenness, const Layout* conformal, bool joins,
                  Execution& execution) const;

 private:
  Flattened(const Sheet& sheet, Cuts cuts, mesh::Surface pieces, Flattening flat)
      : sheet_(&sheet), cuts_(std::move(cuts)), pieces_(std::move(pieces)), flat_(std::move(flat)) {}

  std::vector<char> turn_upright(uv::UvArray& uv) const;
  std::vector<char> seams(const uv::UvArray& uv, const std::vector<Joint>& joints) const;
  uv::Quality quality(const uv::UvArray& uv, Execution& execution) const;

  const Sheet* sheet_;
  Cuts cuts_;
  mesh::Surface pieces_;
  Flattening flat_;
};

}  // namespace holomorph::flat
