// Disjoint sets (union-find), and disjoint sets with signs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace holomorph::mesh {

/// Elements 0 .. count - 1, each at first a set of its own. A set is known by its lowest element.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : lower_(count) { std::iota(lower_.begin(), lower_.end(), 0); }

  int lowest(int i) {
    while (lower_[i] != i) i = lower_[i] = lower_[lower_[i]];
    return i;
  }
  void join(int i, int j) {
    const int a = lowest(i), b = lowest(j);
    lower_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> lower_;
};

/// Elements joined by the relations "alike" and "opposite". Within a set the relations never contradict each other.
class SignedSets {
 public:
  /// @param root #elements one element of each set
  /// @param sign #elements 0 or 1: elements of one set are opposite where theirs differ
  SignedSets(std::vector<int> root, std::vector<char> sign) : up_(std::move(root)), opposite_(std::move(sign)) {
    for (std::size_t i = 0; i < up_.size(); ++i) {
      if (up_[i] != static_cast<int>(i)) opposite_[i] ^= opposite_[up_[i]];
    }
    for (std::size_t i = 0; i < up_.size(); ++i) {
      if (up_[i] == static_cast<int>(i)) opposite_[i] = 0;
    }
  }

  struct Place {
    int root;
    bool opposite;  // to the root
  };
  Place place(int i) {
    Place found{i, false};
    while (up_[found.root] != found.root) {
      found.opposite ^= opposite_[found.root] != 0;
      found.root = up_[found.root];
    }
    for (bool rest = found.opposite; up_[i] != found.root && i != found.root;) {  // shorten the way
      const bool step = opposite_[i] != 0;
      const int next = up_[i];
      up_[i] = found.root;
      opposite_[i] = rest ? 1 : 0;
      rest ^= step;
      i = next;
    }
    return found;
  }

  /// Whether i and j may be opposite, or alike: they are in different sets, or are so already.
  bool allows(int i, int j, bool opposite) {
    const Place a = place(i), b = place(j);
    return a.root != b.root || (a.opposite != b.opposite) == opposite;
  }
  /// @pre allows(i, j, opposite)
  void join(int i, int j, bool opposite) {
    const Place a = place(i), b = place(j);
    if (a.root == b.root) return;
    up_[std::max(a.root, b.root)] = std::min(a.root, b.root);
    opposite_[std::max(a.root, b.root)] = (a.opposite != b.opposite) != opposite ? 1 : 0;
  }

 private:
  std::vector<int> up_;
  std::vector<char> opposite_;
};

}  // namespace holomorph::mesh
