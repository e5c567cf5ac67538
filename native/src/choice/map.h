// The UV map of one connected part, of whichever kind.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "choice/any_structure.h"
#include "choice/seamless_map.h"
#include "flat/arrangement.h"
#include "flat/island_layout.h"
#include "uv/distortion.h"

namespace holomorph::choice {

/// A map whose pieces, cut along hard edges, lie side by side: some with whole tiles, the rest in flat islands.
struct Mixed {
  uv::UvArray uv;                        ///< #C x 2: one tile of the texture is the unit square
  uv::Quality quality;                   ///< with the triangles of one piece after those of another
  std::vector<SeamlessPointer> tilings;  ///< of the pieces that have one; their vertices are those of the part
  std::vector<mesh::Pair> seams;         ///< vertices of the edges where the UVs jump
  double evenness = 0;
  double soft_length = 0, hard_length = 0;  ///< of seams, over the root of the area, as flat::Islands has them
};

/// The map of a combination of a structure's forms.
struct FormMap {
  uv::UvArray uv;
  uv::Quality quality;
  Eigen::VectorXcd coefficients;  ///< with which the structure gives it; empty for a map that is fixed
  double evenness = 0;
};

/// A map, of one of the four kinds.
class Map {
 public:
  Map(PartPointer part, StructurePointer structure, FormMap made, std::string why, Execution& execution);
  /// "it has no visible seams" and so on
  Map(PartPointer part, StructurePointer structure, SeamlessPointer made, Execution& execution);
  Map(PartPointer part, StructurePointer structure, std::shared_ptr<const flat::Islands> made, std::string why,
      Execution& execution);
  Map(PartPointer part, StructurePointer structure, std::shared_ptr<const Mixed> made, std::string why,
      Execution& execution);

  const PartPointer& part() const { return part_; }
  const StructurePointer& structure() const { return structure_; }
  const std::string& why() const { return why_; }
  /// Null for maps of another kind.
  const std::shared_ptr<const FormMap>& forms() const { return forms_; }
  const SeamlessPointer& tiling() const { return tiling_; }
  const std::shared_ptr<const flat::Islands>& islands() const { return islands_; }
  const std::shared_ptr<const Mixed>& mixed() const { return mixed_; }

  const uv::UvArray& uv() const;  ///< #C x 2
  const uv::Quality& quality() const;
  /// Vertices of the edges where the UVs jump.
  std::vector<mesh::Pair> seams(Execution& execution) const;

  /// Whether a texture breaks off when the UVs are moved by anything but whole tiles.
  bool is_tiled() const { return tiling_ || mixed_; }
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
  void measure(Execution& execution);

  PartPointer part_;
  StructurePointer structure_;
  std::string why_;
  std::shared_ptr<const FormMap> forms_;
  SeamlessPointer tiling_;
  std::shared_ptr<const flat::Islands> islands_;
  std::shared_ptr<const Mixed> mixed_;
  int pole_count_ = 0;
  uv::Densities drawn_;
  double cost_ = 0;
};
using MapPointer = std::shared_ptr<const Map>;

/// The size range in three digits.
std::string size_range(const uv::Quality& quality);

/// The map of a combination of a structure's forms.
/// @param coefficients none: those of the balanced map
/// @param is_upright turn the map until v runs up, as far as one turn can do that: by half turns and quarters where its
/// boundary is straight
/// @param evenness as in uv/evening.h; jumps stay, and so do straight and round boundaries
/// @throws SolverError, Cancelled
MapPointer form_map(const PartPointer& part, const StructurePointer& structure,
                    std::optional<Eigen::VectorXcd> coefficients, double evenness, bool is_upright, std::string why,
                    Execution& execution);

}  // namespace holomorph::choice
