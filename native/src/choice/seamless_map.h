// A tiling of either kind as a value: only shifted across its cuts, or also turned.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "choice/part.h"
#include "mesh/surface.h"
#include "tiling/cones/turned_tiling.h"
#include "tiling/rounding_candidate.h"
#include "tiling/tiling.h"
#include "uv/zeros.h"

namespace holomorph::choice {

// What is asked of a tiling.

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

/// Vertices are those of the part, in a map in pieces those of the whole.
struct SeamlessMap {
  uv::UvArray uv;       ///< #C x 2 in tiles: one tile of the texture is the unit square
  uv::Quality quality;  ///< on the triangles of `triangulation`
  std::shared_ptr<const mesh::Surface> triangulation;
  TileOptions asked;                            ///< what it was made by
  double tiles = 0;                             ///< the number that was aimed at: area times median density
  double evenness = 0;                          ///< from 0, conformal, to 1
  std::array<std::complex<double>, 2> lattice;  ///< the translations by which it may jump
  std::vector<mesh::Pair> seams;                ///< vertices of the edges where the UVs jump
  // If it is only shifted:
  std::vector<std::array<std::int64_t, 2>> periods;  ///< in vectors of the lattice, along a homology basis
  std::vector<int> poles;
  std::vector<std::complex<double>> residues;
  std::vector<uv::Zero> zeros;
  double added_distortion = 1, beltrami_rms = 0, optimal_size_range = 1;
  tiling::RoundingRecord rounding;
  std::shared_ptr<const tiling::Tiling> made;  ///< what it is a value of; null where it was changed since
  // If it turns:
  int turns = 1;
  std::vector<int> cones;
  std::vector<double> cone_angles;                 ///< in full turns
  std::vector<std::array<std::int64_t, 3>> jumps;  ///< at each seam: turns, and the translation
  tiling::Rows rows = tiling::Rows::kNone;
};
using SeamlessPointer = std::shared_ptr<const SeamlessMap>;

}  // namespace holomorph::choice
