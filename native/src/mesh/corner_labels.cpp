#include "mesh/corner_labels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

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

}  // namespace

CornerLabels corner_labels(const std::vector<int>& vertices, const std::vector<int>& face_offsets) {
  return Labelling(vertices, face_offsets).labels();
}

}  // namespace holomorph::mesh
