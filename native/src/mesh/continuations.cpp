#include "mesh/continuations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/polygon_edges.h"
#include "mesh/polygon_sides.h"

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;

// Scores that differ by less are equal: the rest is rounding.
constexpr double kSameScore = 1e-6;
// A face bends up beside another by more than this, as a sine; and what that costs beside one that bends down.
constexpr double kConcave = 1e-3;

struct Pairing {
  long score;
  int side, other;

  bool operator<(const Pairing& b) const { return std::tie(score, side, other) < std::tie(b.score, b.side, b.other); }
};

// How a face lies at one of its sides, as it runs: unit vectors, which are rounding for a sliver.
struct Lie {
  Vector3d normal, inward;
  bool is_sliver;
};

// Area over the squared length of the side, up to which a face is a sliver.
constexpr double kLeastShape = 1e-6;

class Scores {
 public:
  Scores(const Polygons& mesh, const std::vector<int>& label, const std::vector<char>& reversed)
      : mesh_(mesh), label_(label), reversed_(reversed), next_(next_corners(mesh)), face_of_(corner_faces(mesh)) {}

  void add_pairings(const std::vector<int>& sides, std::vector<Pairing>& pairings) const {
    std::vector<Lie> lies;
    for (const int s : sides) lies.push_back(lie(s));
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        const bool one = reversed_[face_of_[sides[i]]] != 0, other = reversed_[face_of_[sides[j]]] != 0;
        const bool is_oriented = (one != other) == (label_[sides[i]] == label_[sides[j]]);
        const double bend = (1 + lies[i].inward.dot(lies[j].inward)) / 2;  // 0 where they are flat, 1 folded
        const bool is_concave = lies[j].inward.dot(lies[i].normal) * (one ? -1 : 1) > kConcave;
        // A pair that contradicts the orientation costs as much as a fold.
        const double of_slivers = lies[i].is_sliver || lies[j].is_sliver ? 2 : 0;  // what is left to them
        const double score = (is_oriented ? 0 : 1) + bend + (is_concave ? kConcave : 0) + of_slivers;
        pairings.push_back({std::lround(score / kSameScore), sides[i], sides[j]});
      }
    }
  }

 private:
  Lie lie(int side) const {
    const int face = face_of_[side], first = mesh_.face_offsets[face];
    const auto point = [this](int c) {
      const auto& p = mesh_.vertices[mesh_.corner_vertices[c]];
      return Vector3d(p[0], p[1], p[2]);
    };
    const Vector3d origin = point(first), whole = point(next_[side]) - point(side), along = whole.stableNormalized();
    Vector3d area = Vector3d::Zero();
    for (int c = first; c < mesh_.face_offsets[face + 1]; ++c)
      area += (point(c) - origin).cross(point(next_[c]) - origin);
    const Vector3d normal = area.stableNormalized();
    return {normal, normal.cross(along), area.stableNorm() <= kLeastShape * whole.stableNorm() * whole.stableNorm()};
  }

  const Polygons& mesh_;
  const std::vector<int>& label_;
  const std::vector<char>& reversed_;
  const std::vector<int> next_, face_of_;
};

}  // namespace

std::vector<std::array<int, 2>> continuations(const Polygons& mesh, const std::vector<int>& label,
                                              const std::vector<char>& reversed,
                                              const std::vector<std::vector<int>>& edges) {
  const Scores scores(mesh, label, reversed);
  std::vector<Pairing> pairings;
  for (const auto& sides : edges) scores.add_pairings(sides, pairings);
  std::sort(pairings.begin(), pairings.end());
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [score, side, other] : pairings) pairs.push_back({side, other});
  return pairs;
}

}  // namespace holomorph::mesh
