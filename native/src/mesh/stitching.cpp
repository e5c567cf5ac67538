#include "mesh/stitching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "mesh/polygon_edges.h"

namespace holomorph::mesh {
namespace {

// Spreads the bits of a label, so that sums over faces with other labels differ (splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

class Labelling {
 public:
  Labelling(const std::vector<int>& vertices, const std::vector<int>& face_offsets)
      : offsets_(face_offsets), count_(vertices.empty() ? 0 : *std::max_element(vertices.begin(), vertices.end()) + 1) {
    result_.label = vertices;
  }

  CornerLabels labels() && {
    const int faces = static_cast<int>(offsets_.size()) - 1;
    for (int f = 0; f < faces; ++f) {
      const std::vector<int> set = sorted(f);
      if (std::adjacent_find(set.begin(), set.end()) == set.end()) continue;
      result_.repeated.push_back(f);
      for (int c = offsets_[f]; c < offsets_[f + 1]; ++c) result_.label[c] = count_++;
    }
    layer_twins(faces);
    return std::move(result_);
  }

 private:
  std::vector<int> sorted(int face) const {
    std::vector<int> set(result_.label.begin() + offsets_[face], result_.label.begin() + offsets_[face + 1]);
    std::sort(set.begin(), set.end());
    return set;
  }

  // Faces on the same vertices, by a sum that does not depend on the order of these.
  void layer_twins(int faces) {
    std::vector<std::pair<std::uint64_t, int>> by_sum(faces);
    for (int f = 0; f < faces; ++f) {
      by_sum[f] = {0, f};
      for (int c = offsets_[f]; c < offsets_[f + 1]; ++c) by_sum[f].first += mixed(result_.label[c] + 1);
    }
    std::sort(by_sum.begin(), by_sum.end());
    std::vector<std::array<int, 3>> twins;  // face, its layer, the first one on these vertices
    for (std::size_t i = 0, j; i < by_sum.size(); i = j) {
      for (j = i + 1; j < by_sum.size() && by_sum[j].first == by_sum[i].first;) ++j;
      if (j > i + 1) add_twins(by_sum.begin() + i, by_sum.begin() + j, twins);
    }
    std::sort(twins.begin(), twins.end());
    for (const auto& [face, layer, first] : twins) {
      (runs_against(face, first) ? result_.opposite : result_.twice).push_back(face);
    }
    for (const auto& [face, layer, first] : twins) lift(face, layer);
  }

  template <class Iterator>
  void add_twins(Iterator begin, Iterator end, std::vector<std::array<int, 3>>& twins) const {
    std::map<std::vector<int>, std::array<int, 2>> seen;  // the first face on these vertices, and how many there are
    for (; begin != end; ++begin) {
      const auto [place, is_first] = seen.try_emplace(sorted(begin->second), std::array<int, 2>{begin->second, 0});
      if (!is_first) twins.push_back({begin->second, ++place->second[1], place->second[0]});
    }
  }

  bool runs_against(int face, int first) const {
    const int* const own = result_.label.data() + offsets_[face];
    const int* const other = result_.label.data() + offsets_[first];
    const int size = offsets_[face + 1] - offsets_[face];
    const auto shift = static_cast<int>(std::find(other, other + size, own[0]) - other);
    for (int i = 0; i < size; ++i) {
      if (own[i] != other[(shift + size - i) % size]) return false;
    }
    return true;
  }

  // Layer k of a vertex has a label of its own: twins form sheets, as the faces below them do.
  void lift(int face, int layer) {
    for (int c = offsets_[face]; c < offsets_[face + 1]; ++c) {
      const std::int64_t key = (static_cast<std::int64_t>(layer) << 32) | result_.label[c];
      const auto [place, is_new] = lifted_.try_emplace(key, count_);
      if (is_new) ++count_;
      result_.label[c] = place->second;
    }
  }

  const std::vector<int>& offsets_;
  int count_;  // labels so far
  std::unordered_map<std::int64_t, int> lifted_;
  CornerLabels result_;
};

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

class Joiner {
 public:
  Joiner(const Polygons& mesh, const std::vector<int>& label)
      : mesh_(mesh),
        label_(label),
        next_(next_corners(mesh)),
        face_of_(corner_faces(mesh)),
        fans_(label.size()),
        edge_of_(label.size(), -1) {
    result_.partner.assign(label.size(), -1);
  }

  SideJoins joined() && {
    take_edges();
    result_.sheets = oriented_sheets();
    for (int s = 0; s < static_cast<int>(label_.size()); ++s) {
      if (result_.partner[s] > s) join_fans(s, result_.partner[s]);
    }
    continue_sheets();
    for (const auto& sides : result_.many) join_what_closed(sides);
    result_.fan.resize(label_.size());
    for (int c = 0; c < static_cast<int>(label_.size()); ++c) result_.fan[c] = fans_.lowest(c);
    return std::move(result_);
  }

 private:
  using Ends = std::array<int, 2>;  // the fans at the lower and the higher label

  struct Joining {
    int s, t;         // sides
    Ends one, other;  // their ends

    bool holds(int side) const { return side == s || side == t; }
    Ends merged(Ends ends) const {
      for (int& fan : ends) {
        if (fan == other[0]) fan = one[0];
        if (fan == other[1]) fan = one[1];
      }
      return ends;
    }
  };

  void take_edges() {
    for_edges(mesh_, label_, [this](const LabelledSide* begin, const LabelledSide* end) {
      if (end - begin == 2) {
        result_.partner[begin->corner] = begin[1].corner;
        result_.partner[begin[1].corner] = begin->corner;
      } else if (end - begin > 2) {
        std::vector<int>& sides = result_.many.emplace_back();
        for (; begin != end; ++begin) {
          edge_of_[begin->corner] = static_cast<int>(result_.many.size()) - 1;
          sides.push_back(begin->corner);
        }
      }
    });
  }

  bool run_alike(int s, int t) const { return label_[s] == label_[t]; }

  // Floods the faces across joined sides, and takes apart those at which the orientations contradict. Each sheet is
  // oriented as the majority of its faces is given.
  SignedSets oriented_sheets() {
    const int faces = static_cast<int>(mesh_.face_offsets.size()) - 1;
    std::vector<int> root(faces, -1), flood;
    reversed_.assign(faces, 0);
    for (int start = 0; start < faces; ++start) {
      if (root[start] >= 0) continue;
      flood.assign(1, start);
      root[start] = start;
      for (std::size_t head = 0; head < flood.size(); ++head) flood_from(flood[head], root, flood);
      const auto count = std::count_if(flood.begin(), flood.end(), [this](int f) { return reversed_[f] != 0; });
      if (2 * static_cast<std::size_t>(count) > flood.size()) {
        for (const int f : flood) reversed_[f] ^= 1;
      }
    }
    return {std::move(root), reversed_};
  }

  void flood_from(int face, std::vector<int>& root, std::vector<int>& flood) {
    for (int s = mesh_.face_offsets[face]; s < mesh_.face_offsets[face + 1]; ++s) {
      const int t = result_.partner[s];
      if (t < 0) continue;
      const int other = face_of_[t];
      const char wanted = reversed_[face] ^ static_cast<char>(run_alike(s, t));
      if (root[other] < 0) {
        root[other] = root[face];
        reversed_[other] = wanted;
        flood.push_back(other);
      } else if (reversed_[other] != wanted) {
        result_.partner[s] = result_.partner[t] = -1;
        result_.sided.push_back({std::min(s, t), std::max(s, t)});
      }
    }
  }

  void join_fans(int s, int t) {
    const bool alike = run_alike(s, t);
    // Sides of two faces that are oriented alike run in opposite directions: the start of one is the end of the other.
    fans_.join(s, alike ? t : next_[t]);
    fans_.join(next_[s], alike ? next_[t] : t);
  }

  void continue_sheets() {
    SignedSets& sheets = result_.sheets;
    for (const auto& sides : result_.many) {
      for (const int s : sides) {
        for (const int end : ends(s)) sides_at_[end].push_back(s);
      }
    }
    for (const auto& [s, t] : continuations(mesh_, label_, reversed_, result_.many)) {
      const int f = face_of_[s], g = face_of_[t];
      if (result_.partner[s] >= 0 || result_.partner[t] >= 0 || !sheets.allows(f, g, run_alike(s, t))) continue;
      if (!has_room(s, t)) continue;
      sheets.join(f, g, run_alike(s, t));
      join(s, t);
    }
  }

  Ends ends(int s) {
    const Ends found{fans_.lowest(s), fans_.lowest(next_[s])};
    return label_[s] < label_[next_[s]] ? found : Ends{found[1], found[0]};
  }

  // Whether two sides of an edge that are not joined run between the same vertices once `asked` are joined. Sides that
  // are apart may do so in pairs: a fan has two ends, at which it closes.
  bool collide(int x, int y, const Joining& asked) {
    if (x == y || result_.partner[x] == y || asked.merged(ends(x)) != asked.merged(ends(y))) return false;
    if (asked.holds(x) && asked.holds(y)) return false;
    return asked.holds(x) || asked.holds(y) || result_.partner[x] >= 0 || result_.partner[y] >= 0;
  }

  // Whether no edge gets a second copy between two vertices when these sides are joined.
  bool has_room(int s, int t) {
    const Joining asked{s, t, ends(s), ends(t)};
    for (int k = 0; k < 2; ++k) {
      if (asked.one[k] == asked.other[k]) continue;
      const auto &a = sides_at_[asked.one[k]], &b = sides_at_[asked.other[k]];
      for (const int x : a.size() < b.size() ? a : b) {
        const auto& copies = result_.many[edge_of_[x]];
        if (std::any_of(copies.begin(), copies.end(), [&](int y) { return collide(x, y, asked); })) return false;
      }
    }
    return true;
  }

  void join(int s, int t) {
    const Ends one = ends(s), other = ends(t);
    result_.partner[s] = t;
    result_.partner[t] = s;
    join_fans(s, t);
    const Ends now = ends(s);
    for (int k = 0; k < 2; ++k) {
      if (one[k] == other[k]) continue;
      std::vector<int> a = std::move(sides_at_[one[k]]), b = std::move(sides_at_[other[k]]);
      if (a.size() < b.size()) std::swap(a, b);
      a.insert(a.end(), b.begin(), b.end());
      sides_at_[now[k]] = std::move(a);
    }
  }

  // Sides that are left apart, but run between the same two vertices now.
  void join_what_closed(const std::vector<int>& sides) {
    for (const int s : sides) {
      for (const int t : sides) {
        if (s >= t || result_.partner[s] >= 0 || result_.partner[t] >= 0 || ends(s) != ends(t)) continue;
        result_.partner[s] = t;
        result_.partner[t] = s;
      }
    }
  }

  const Polygons& mesh_;
  const std::vector<int>& label_;
  const std::vector<int> next_, face_of_;
  UnionFind fans_;                                      // sets of corners
  std::vector<char> reversed_;                          // #F
  std::vector<int> edge_of_;                            // #C index into `many`, -1 elsewhere
  std::unordered_map<int, std::vector<int>> sides_at_;  // sides of `many`, by the fan at one of their ends
  SideJoins result_;
};

}  // namespace

CornerLabels corner_labels(const std::vector<int>& vertices, const std::vector<int>& face_offsets) {
  return Labelling(vertices, face_offsets).labels();
}

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

SideJoins join_sides(const Polygons& mesh, const std::vector<int>& label) { return Joiner(mesh, label).joined(); }

}  // namespace holomorph::mesh
