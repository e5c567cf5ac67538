// What is asked of a tiling.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "mesh/surface.h"
#include "tiling/cones/turned_tiling.h"
#include "tiling/rounding_candidate.h"

namespace holomorph::choice {

/// Which way rows run: v up, as far as it can, u along a vector, or as is most even.
struct Heading {
  enum class Kind { kUpright, kVector, kAny };
  Kind kind = Kind::kUpright;
  std::array<double, 3> vector{};  ///< in space

  bool is_upright() const { return kind == Kind::kUpright; }
  bool operator==(const Heading&) const = default;
};

/// What poles a tiling has.
struct PoleChoice {
  std::optional<int> count = {};   ///< none: as many as the density asks for
  std::vector<int> vertices = {};  ///< chosen ones, which stay where they are; `count` is their number
  std::vector<char> allowed = {};  ///< #V where others may be; empty: anywhere

  bool is_open() const { return !count; }
  bool are_none() const { return count == 0 && vertices.empty(); }
  bool operator==(const PoleChoice&) const = default;
};

/// Boundary loops along lines of constant v; free for a more even density; or as suits the mesh.
enum class BoundaryLines { kAutomatic, kStraight, kFree };

/// What is asked of a tiling (tiling/tiling.h, tiling/cones/turned_tiling.h).
struct TileOptions {
  double tiles = 0;  ///< 0: a number that suits it
  double evenness = 0;
  PoleChoice poles;
  std::array<std::complex<double>, 2> lattice{1.0, std::complex<double>(0, 1)};
  Heading heading;
  std::optional<double> turn;
  double max_turn = 0.2;
  BoundaryLines boundary = BoundaryLines::kAutomatic;
  std::optional<double> max_added;  ///< the largest angle distortion that rounding may add
  bool size_counts = false;
  std::vector<tiling::PoleMove> moves;  ///< after the rounding
  // If it turns:
  int turns = 1;
  tiling::Rows rows = tiling::Rows::kNone;
  std::vector<mesh::Pair> marked;           ///< edges that are lines, too
  std::optional<std::vector<int>> missing;  ///< #V k-th turns that are missing around chosen cones

  bool operator==(const TileOptions&) const = default;
};

}  // namespace holomorph::choice
