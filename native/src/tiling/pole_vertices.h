// The vertices that poles may go to, and the Abel-Jacobi map there.
#pragma once

#include <vector>

#include "tiling/abel_jacobi.h"
#include "tiling/landscape.h"

namespace holomorph::tiling {

class PoleVertices {
 public:
  /// All three outlive this. @param allowed #V; empty: anywhere
  PoleVertices(const Landscape& landscape, const AbelJacobi& abel_jacobi, const std::vector<char>& allowed);

  bool is_allowed(int vertex) const;
  /// The vertices of its star, ascending.
  std::vector<int> corners_around(int vertex) const;
  /// Those that are allowed among about `most` vertices around this one, itself among them, the nearest first.
  std::vector<int> around(int vertex, std::size_t most) const;
  /// C there, 2g, of all its representatives the nearest to another.
  Eigen::VectorXd part(int vertex, const Eigen::VectorXd& near) const;

 private:
  const Landscape& landscape_;
  const AbelJacobi& abel_jacobi_;
  const std::vector<char>& allowed_;
};

/// Whether two ascending lists have nothing in common.
bool are_apart(const std::vector<int>& a, const std::vector<int>& b);

}  // namespace holomorph::tiling
