// A progressive mesh as one block of bytes, little-endian on every machine.
//
//   8 bytes   "HoloPM\r\n"
//   u32       version, 1
//   u32       1: triangles name their polygon corners, 2: polygons that are not triangles; or both
//   u64 x 8   base triangles, base vertices, splits, vertices, triangles, polygons, bytes of the corner type, bytes of
//             corner data
//   i32       base triangles (3 each); splits: all v_s, all v_l, all v_r
//   u8        splits: slot_l + 4 slot_r
//   f64       positions (3 each)
//   i32       vertex index, triangle index; triangle corners (3 each) if there are any; face offsets if there are any
//   bytes     corner type, corner data
#pragma once

#include <string_view>
#include <vector>

#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

std::vector<char> to_bytes(const ProgressiveMesh& mesh);

/// Every count, index and split is checked, and every split is made once.
/// @throws InvalidMesh with what is wrong
ProgressiveMesh from_bytes(std::string_view bytes);

}  // namespace holomorph::progressive
