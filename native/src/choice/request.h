// What is asked for of one connected part.
#pragma once

#include <optional>

#include "choice/any_structure.h"
#include "choice/seamless_map.h"
#include "flat/island_search.h"
#include "uv/evening.h"

namespace holomorph::choice {

/// The map of least cost; a tiling in any case; the best of the others; a map of forms; islands between chosen cuts.
enum class Main { kAutomatic, kSeamless, kUntiled, kBalanced, kIslands };

struct Request {
  PartPointer part;
  StructurePointer structure = nullptr;  ///< null to make it, by `automatic_structure`
  Main main = Main::kAutomatic;
  double evenness = uv::kUsualEvenness;
  /// What is asked of tilings besides; its number of tiles, `size_counts`, `evenness` and `rows` do not count.
  TileOptions tiling = {};
  std::optional<tiling::Rows> rows = {};  ///< of tilings that turn; none: those that cost little
  flat::ChosenCuts cuts = {};             ///< of islands
  double effort = 1;                      ///< see `Budget` (choice/candidate.h)

  /// Whether v is to run up.
  bool is_upright() const { return tiling.heading.is_upright(); }
};

}  // namespace holomorph::choice
