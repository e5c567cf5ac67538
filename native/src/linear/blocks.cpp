#include "linear/blocks.h"

#include <Eigen/QR>
#include <algorithm>
#include <numeric>
#include <vector>

#include "base/errors.h"

namespace holomorph::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUsualSteps = 20000;  // that reducing all blocks takes, for progress
constexpr Index kPanel = 32, kChunkOfColumns = 128;
constexpr double kLargest = 9007199254740992;  // 2^53

struct Block {
  Index begin, size;
  ReducedBasis reduced = {};

  Index end() const { return begin + size; }
  bool is_changed() const { return !reduced.transform.isIdentity(0); }
};

std::vector<Block> blocks_from(Index first, Index n) {
  std::vector<Block> blocks;
  for (Index begin = first; begin + 1 < n; begin += kBlock)
    blocks.push_back({begin, std::min<Index>(kBlock, n - begin)});
  return blocks;
}

// Multiplies by an orthogonal matrix that makes the first n columns upper triangular; it can be cancelled meanwhile.
void triangularise(MatrixXd& A, Index n, Execution& execution) {
  for (Index j = 0; j < n; j += kPanel) {
    execution.report(static_cast<double>(j) / static_cast<double>(n));
    const Index width = std::min(kPanel, n - j), rows = A.rows() - j, after = A.cols() - j - width;
    const Eigen::HouseholderQR<MatrixXd> panel(A.block(j, j, rows, width));
    A.block(j, j, rows, width) = panel.matrixQR().triangularView<Eigen::Upper>();
    run_long_tasks(execution.workers(), static_cast<int>((after + kChunkOfColumns - 1) / kChunkOfColumns), [&](int i) {
      const Index begin = i * kChunkOfColumns;
      A.block(j, j + width + begin, rows, std::min(kChunkOfColumns, after - begin))
          .applyOnTheLeft(panel.householderQ().adjoint());
    });
  }
}

class BlockReduction {
 public:
  BlockReduction(const MatrixXd& B, MatrixXd& points, Execution& execution)
      : execution_(execution), watch_(execution, kUsualSteps, static_cast<double>(B.cols())), n_(B.cols()) {
    std::vector<Index> order(n_);
    std::iota(order.begin(), order.end(), Index{0});
    const VectorXd length = B.colwise().norm();
    // Short vectors first, as in a reduced basis.
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return length[i] < length[j]; });
    MatrixXd all(B.rows(), n_ + points.cols());
    all << B(Eigen::all, order), points;
    triangularise(all, n_, execution);
    R_ = all.topLeftCorner(n_, n_).triangularView<Eigen::Upper>();
    points = all.topRightCorner(n_, points.cols());
    for (Index j = 0; j < n_; ++j) {
      // Householder reflections leave the signs of the diagonal open.
      if (R_(j, j) >= 0) continue;
      R_.row(j) *= -1;
      points.row(j) *= -1;
    }
    transform_ = MatrixXd::Identity(n_, n_)(Eigen::all, order);
    points_ = &points;
  }

  ReducedBasis run() {
    for (int round = 0; round < kMostRounds; ++round) {
      const bool changed = reduce_all(0);
      // Every second pass has its blocks shifted by half a block, so that vectors cross the borders of the first ones.
      if (!reduce_all(kBlock / 2) && !changed) break;
    }
    return {R_, transform_.cast<std::int64_t>(), MatrixXd::Identity(n_, n_), R_, steps_, blocks_};
  }

 private:
  // @return whether one was changed
  bool reduce_all(Index first) {
    std::vector<Block> blocks = blocks_from(first, n_);
    blocks_ = std::max<int>(blocks_, static_cast<int>(blocks.size()));
    run_long_tasks(execution_.workers(), static_cast<int>(blocks.size()), [&](int thread, int i) {
      Block& b = blocks[i];
      b.reduced = reduce(R_.block(b.begin, b.begin, b.size, b.size), 0.99, [&] { watch_(thread); });
    });
    bool changed = false;
    for (const Block& b : blocks) {
      steps_ += b.reduced.steps;
      if (!b.is_changed()) continue;
      apply(b);
      changed = true;
    }
    return changed;
  }

  void apply(const Block& b) {
    const MatrixXd U = b.reduced.transform.cast<double>();
    const MatrixXd turn = b.reduced.Q.transpose();
    // Columns above the block are combined as its own, rows to the right of it are turned by its QR: R stays
    // triangular.
    R_.block(0, b.begin, b.begin, b.size) *= U;
    R_.block(b.begin, b.begin, b.size, b.size) = b.reduced.R;
    R_.block(b.begin, b.end(), b.size, n_ - b.end()).applyOnTheLeft(turn);
    points_->middleRows(b.begin, b.size).applyOnTheLeft(turn);
    transform_.middleCols(b.begin, b.size) *= U;
    if (!(transform_.middleCols(b.begin, b.size).cwiseAbs().maxCoeff() <= kLargest))
      throw SolverError("the lattice needs integers beyond 2^53");
  }

  Execution& execution_;
  TaskProgress watch_;
  Index n_;
  MatrixXd R_, transform_;  // the transform is integral
  MatrixXd* points_ = nullptr;
  std::int64_t steps_ = 0;
  int blocks_ = 1;
};

}  // namespace

ReducedBasis reduce_by_blocks(const MatrixXd& B, MatrixXd& points, Execution& execution) {
  return BlockReduction(B, points, execution).run();
}

}  // namespace holomorph::linear
