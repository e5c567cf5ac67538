// The UV map of one connected part, of whichever kind.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "choice/any_structure.h"
#include "choice/seamless_map.h"
#include "flat/arrangement.h"
#include "flat/island_layout.h"
#include "uv/appearance.h"

namespace holomorph::choice {

using LayoutPointer = std::shared_ptr<const flat::Layout>;

/// A map: a tiling; in pieces between hard edges, some of them tilings and the rest islands; in flat islands; or of a
/// combination of forms.
class Map {
 public:
  /// @param tilings of the pieces that have one; their vertices are those of the part
  /// @param coefficients with which the structure gives the map; empty for one that is fixed
  Map(PartPointer part, StructurePointer structure, LayoutPointer made, std::string why, Execution& execution,
      std::vector<SeamlessPointer> tilings = {}, Eigen::VectorXcd coefficients = {});
  /// "it has no visible seams" and so on
  Map(PartPointer part, StructurePointer structure, SeamlessPointer made, Execution& execution);

  const PartPointer& part() const { return part_; }
  const StructurePointer& structure() const { return structure_; }
  const std::string& why() const { return why_; }
  /// Null where the whole is none.
  const SeamlessPointer& tiling() const { return layout_ ? kNone : tilings_.front(); }
  /// The tiling, or those of pieces.
  const std::vector<SeamlessPointer>& tilings() const { return tilings_; }
  /// Null for a tiling.
  const LayoutPointer& layout() const { return layout_; }
  bool is_in_islands() const { return layout_ && layout_->islands > 0; }
  bool is_in_pieces() const { return layout_ && is_tiled(); }
  /// Whether a texture breaks off when the UVs are moved by anything but whole tiles.
  bool is_tiled() const { return !tilings_.empty(); }
  const Eigen::VectorXcd& coefficients() const { return coefficients_; }

  const uv::UvArray& uv() const { return layout_ ? layout_->uv : tilings_.front()->uv; }  ///< #C x 2
  const uv::Quality& quality() const { return layout_ ? layout_->quality : tilings_.front()->quality; }
  double evenness() const { return layout_ ? layout_->evenness : tilings_.front()->evenness; }
  /// Vertices of the edges where the UVs jump.
  const std::vector<mesh::Pair>& seams() const { return layout_ ? layout_->seams : tilings_.front()->seams; }

  int pole_count() const { return pole_count_; }
  /// 2, 4 or 6 where the UVs may turn by this part of a full turn across a seam; else 1.
  int turns() const;
  /// UV area per area of the surface, the median by that over the triangles that are drawn: tiles of a tiling.
  double density() const { return drawn_.median; }
  /// Root of the 95 % over 5 % quantile of that.
  double drawn_range() const;
  /// The cost to the eye, see uv/appearance.h; infinite for a map that is `flat::kScattered`.
  double cost() const { return cost_; }

  /// The same with another reason.
  std::shared_ptr<const Map> because(std::string why) const;

 private:
  static inline const SeamlessPointer kNone = nullptr;

  void measure(Execution& execution);

  PartPointer part_;
  StructurePointer structure_;
  std::string why_;
  LayoutPointer layout_;
  std::vector<SeamlessPointer> tilings_;
  Eigen::VectorXcd coefficients_;
  int pole_count_ = 0;
  uv::Densities drawn_;
  double cost_ = 0;
};
using MapPointer = std::shared_ptr<const Map>;

/// The size range in three digits.
std::string size_range(const uv::Quality& quality);

/// The map of the balanced combination of a structure's forms.
/// @param is_upright turn the map until v runs up, as far as one turn can do that: by half turns and quarters where its
/// boundary is straight
/// @param evenness as in uv/evening.h; jumps stay, and so do straight and round boundaries
/// @throws SolverError, Cancelled
MapPointer form_map(const PartPointer& part, const StructurePointer& structure, double evenness, bool is_upright,
                    std::string why, Execution& execution);

}  // namespace holomorph::choice
