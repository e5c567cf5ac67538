// What is asked for of one connected part.
#pragma once

#include <optional>

#include "choice/any_structure.h"
#include "choice/tile_options.h"
#include "uv/evening.h"

namespace holomorph::choice {

/// The map of least cost; a tiling in any case; the best of the others; or a map of forms.
enum class Main { kAutomatic, kSeamless, kUntiled, kBalanced };

struct Request {
  PartPointer part;
  StructurePointer structure = nullptr;  ///< null to make it, by `automatic_structure`
  Main main = Main::kAutomatic;
  double evenness = uv::kUsualEvenness;
  std::optional<Eigen::VectorXcd> coefficients = {};  ///< of a balanced map; none: those of the most even one
  /// What is asked of tilings besides; its number of tiles, `size_counts`, `evenness` and `rows` do not count.
  TileOptions tiling = {};
  std::optional<tiling::Rows> rows = {};  ///< of tilings that turn; none: those that cost little
  double effort = 1;                      ///< see `Budget`

  /// Whether v is to run up.
  bool is_upright() const { return tiling.heading.is_upright(); }
};

}  // namespace holomorph::choice
