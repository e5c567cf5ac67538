// Inner products of forms, and their averaged star.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "base/execution.h"
#include "base/workers.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"
#include "mesh/intrinsic_surface.h"

namespace holomorph::forms {

/// Elements per block.
inline constexpr int kBlock = 4096;
/// Blocks that run in parallel before their sums are added and the progress function is called.
inline constexpr int kBatch = 16;

/// Runs `work(slot, begin, end)` on all blocks, batch by batch, and after each batch `collect(slot)` in the order of
/// its blocks; slots are 0 .. kBatch - 1. @param from,to of the progress function
/// @tparam size elements per block
template <int size = kBlock, class Work, class Collect>
void for_blocks(std::size_t elements, Execution& execution, double from, double to, Work work, Collect collect) {
  Workers& workers = execution.workers();
  const int blocks = static_cast<int>((elements + size - 1) / size);
  for (int first = 0; first < blocks; first += kBatch) {
    const int count = std::min(kBatch, blocks - first);
    run_throwing(workers, count, [&](int slot) {
      const std::size_t begin = static_cast<std::size_t>(first + slot) * size;
      work(slot, static_cast<int>(begin), static_cast<int>(std::min<std::size_t>(elements, begin + size)));
    });
    for (int slot = 0; slot < count; ++slot) collect(slot);
    execution.report(from + (to - from) * (first + count) / blocks);
  }
}

/// G_ij = sum_e k_e h_i(e) h_j(e), exactly the L2 products of the piecewise constant forms.
struct GramMatrix {
  Eigen::MatrixXd value;
  Eigen::MatrixXd uncertain;  ///< the same sums with the errors of the weights in place of the weights
  Eigen::VectorXd size;       ///< sum_e (|k_e| + |u_e|) h_i(e)^2, u the errors of the weights
  Eigen::VectorXd cut_size;   ///< sum_e (|k_e| + |u_e|) eta_i(e)^2, eta_i the integer class
  int summands = 0;           ///< additions that one product goes through, at most
};

/// Computes the Gram matrix of each family of forms. Sums go over blocks of edges in a fixed order, so that the bits do
/// not depend on the number of threads. Blocks without weights cost nothing.
/// @param errors mesh::energy_errors, or none: then only `value` is set
/// @param families numbers of forms of consecutive families. @return one for each
std::vector<GramMatrix> gram_matrices(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                      std::span<const double> errors, const ClosedForms& forms,
                                      const std::vector<int>& families, Execution& execution);

/// Bounds the rounding: returns a positive definite matrix E with G_exact <= value + E as quadratic forms. G_exact has
/// the energies on the surface as given, of the forms eta_i + d f_i with f_i as stored. E bounds all errors together:
/// those of the weights, of differences of functions and of the sums in any order.
Eigen::MatrixXd gram_errors(const GramMatrix& gram);

/// Averages the face-wise star: on each edge the mean over its two faces, or the value on its one face. The result is
/// not closed, so it has no well-defined integral.
/// @param triangulation mollified: in a triangle without area there is no star
/// @param form,result #E values along half-edge 2e
std::vector<double> averaged_star(const mesh::IntrinsicTriangulation& triangulation, const std::vector<double>& form);

}  // namespace holomorph::forms
