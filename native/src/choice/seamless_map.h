// A tiling of either kind as a value: only shifted across its cuts, or also turned.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "choice/part.h"
#include "tiling/cones/turned_tiling.h"
#include "tiling/tiling.h"
#include "uv/zeros.h"

namespace holomorph::choice {

/// Vertices are those of the part, in a map in pieces those of the whole.
struct SeamlessMap {
  uv::UvArray uv;       ///< #C x 2 in tiles: one tile of the texture is the unit square
  uv::Quality quality;  ///< on the triangles of `triangulation`
  std::shared_ptr<const mesh::Surface> triangulation;
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
