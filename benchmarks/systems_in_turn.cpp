// SPDX-License-Identifier: GPL-3.0-or-later
// systems_in_turn MESH SYSTEMS ROUNDS: a line of JSON with the seconds of one iteration of multigrid, four right-hand
// sides, of a system that is solved alone, and of one of so many equal systems of which each does an iteration in turn.
// When a system's turn comes again, the others have put its arrays out of the caches, as a system so many times larger
// does with its own. Medians of the rounds.
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "linear_system.h"
#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "solver/multigrid/block_solve.h"

namespace {

using namespace holomorph;
constexpr int kRightHandSides = 4;
constexpr double kResidual = 1e-10;

// Threads of which one at a time goes on, until it passes the turn to the next.
class Turn {
 public:
  explicit Turn(int count) : going_(count, true) {}

  void wait(int i) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return turn_ == i; });
  }
  void pass(int i) {
    const std::lock_guard lock(mutex_);
    const auto count = static_cast<int>(going_.size());
    do {
      turn_ = (turn_ + 1) % count;
    } while (!going_[turn_] && turn_ != i);
    changed_.notify_all();
  }
  void end(int i) {
    {
      const std::lock_guard lock(mutex_);
      going_[i] = false;
    }
    pass(i);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<bool> going_;
  int turn_ = 0;
};

struct System {
  Eigen::MatrixXd B;
  solver::Solution X;
  solver::Laplacian L;
  solver::Hierarchy hierarchy;

  explicit System(const mesh::Surface& surface) {
    Execution silent;
    B = benchmarks::right_hand_sides(surface.vertex_count, kRightHandSides);
    X.resize(B.rows(), B.cols());
    L = benchmarks::assembled(surface, true);
    hierarchy = solver::make_hierarchy(L, {}, silent);
  }

  /// @return iterations, after each of which `report` is called
  int solve(const std::function<void()>& report) {
    Workers workers;
    solver::BlockSolve<kRightHandSides> block(L, hierarchy, kResidual, workers);
    const std::vector<solver::Condition> conditions(kRightHandSides, solver::Condition::natural);
    block.solve(B, conditions, 0, kRightHandSides, X, [&](double) { report(); });
    return block.iterations();
  }
};

// Seconds per iteration and system.
double alone(std::vector<System>& systems) {
  int iterations = 0;
  const double start = benchmarks::now();
  for (System& system : systems) iterations += system.solve([] {});
  return (benchmarks::now() - start) / iterations;
}

double in_turn(std::vector<System>& systems) {
  const auto count = static_cast<int>(systems.size());
  Turn turn(count);
  std::vector<int> iterations(count);
  std::vector<std::thread> threads;
  const double start = benchmarks::now();
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      turn.wait(i);
      iterations[i] = systems[i].solve([&] {
        turn.pass(i);
        turn.wait(i);
      });
      turn.end(i);
    });
  }
  int all = 0;
  for (int i = 0; i < count; ++i) {
    threads[i].join();
    all += iterations[i];
  }
  return (benchmarks::now() - start) / all;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: systems_in_turn MESH SYSTEMS ROUNDS\n");
    return 2;
  }
  Execution silent;
  const auto surface = mesh::make_surface(mesh::read(argv[1]), silent);
  const int count = std::stoi(argv[2]), rounds = std::stoi(argv[3]);
  std::vector<System> systems;
  for (int i = 0; i < count; ++i) systems.emplace_back(surface);
  std::vector<double> seconds_alone, seconds_in_turn;
  for (int r = 0; r < rounds; ++r) {
    seconds_alone.push_back(alone(systems));
    seconds_in_turn.push_back(in_turn(systems));
  }
  std::printf("{\"alone\": %.6f, \"in_turn\": %.6f}\n", median(seconds_alone), median(seconds_in_turn));
}
