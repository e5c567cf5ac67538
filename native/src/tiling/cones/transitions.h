// How the directions of a turned map continue across edges: the connection with the wanted cones, and its cut.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {

// The values that lines of a lattice have: which parts of a function are one number along them.

/// A sum of multiples of whole numbers, or of lines, by their numbers.
using Multiples = std::map<int, double>;

inline void add_to(Multiples& sum, const Multiples& other, double factor = 1) {
  if (factor == 0) return;
  for (const auto& [number, multiple] : other) sum[number] += factor * multiple;
}

/// Parts of a function, 2 v and 2 v + 1 at vertex v. Those on one line are its root, or less that, and whole numbers.
class LineValues {
 public:
  /// @param whole whether lines have whole numbers. Where a line meets itself turned round, it would be half of one:
  /// that is to be whole then
  LineValues(int vertex_count, bool whole) : parent_(2 * static_cast<std::size_t>(vertex_count)), whole_(whole) {}

  /// factor times a part, and the offset; the offset alone where the part is -1.
  struct Value {
    int part = -1, factor = 1;
    Multiples offset;
  };
  /// What is to be 0.
  struct Equation {
    Multiples roots, offset;
  };

  void equate(const Value& a, const Value& b);
  /// Asks that a sum of multiples of parts, and of whole numbers, be 0. The parts become lines if they are on none.
  void vanish(const Multiples& parts, Multiples offset);

  std::optional<Value> find(int part);  ///< by the root, or by whole numbers alone; none: it is on no line
  std::vector<int> roots();             ///< ascending
  std::vector<Equation> equations();

 private:
  Value resolved(const Value& value);
  Value& above(int part) { return held(parent_[part]); }

  std::vector<std::optional<Value>> parent_;  // none on no line; itself at a root
  const bool whole_;
  std::vector<Equation> equations_;  // of parts that were roots
};

/// A flat metric with cones, its log scale u and its directions: frame theta on each triangle, so that u of the map
/// runs at the angle theta in the triangle's plane. Frames continue across edges but for turns.
struct Frames {
  Eigen::VectorXd scale;      ///< #V, u
  std::vector<double> angle;  ///< #T, theta
  std::vector<double> level;  ///< #T, theta pulled level, which whole numbers are rounded for as well; empty for none
  /// #sides: across a cut edge x' = R^turn x + translation, from the triangle to the twin's; -1 for an edge that is not
  /// cut
  std::vector<int> turn;
};

/// @param missing #V, cones (cones.h). @throws SolverError
Frames make_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing);

/// The log scale u of the flat metric with these cones.
Eigen::VectorXd log_scale(const Net& net, Laplace& laplace, int k, const std::vector<int>& missing);

/// Makes the turns of frames 0 across a tree of triangles, and finds the cut.
/// @param angle #T; changed by k-th turns. @param turned #sides, k-th turns from the triangle to the twin's; changed
/// @return Frames::turn. @throws SolverError turns are left elsewhere than on the cut
std::vector<int> cut_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing,
                            std::vector<double>& angle, std::vector<int>& turned);

}  // namespace holomorph::tiling
