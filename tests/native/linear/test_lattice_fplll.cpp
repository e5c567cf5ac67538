// Comparison with the program fplll (Debian: fplll-tools), where it is installed.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "lattices.h"
#include "linear/reduction.h"

namespace holomorph::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Reduced bases differ with the order of the exchanges.
constexpr double kAsGood = 1.2;
constexpr double kOffLattice = 1e-9;

double log_volume(const MatrixXd& basis) {
  return Eigen::HouseholderQR<MatrixXd>(basis).matrixQR().diagonal().array().abs().log().sum();
}

// Vectors are rows there.
void write(std::ostream& out, const IntegerMatrix& columns) {
  out << "[";
  for (const auto& column : columns.colwise()) out << "[" << column.transpose() << "]\n";
  out << "]\n";
}

class Fplll : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v fplll >/dev/null") != 0) GTEST_SKIP() << "the program fplll is not installed";
  }

  // All numbers that the program prints, one vector of `rows` numbers in each column.
  static MatrixXd run(const std::string& options, Index rows, const std::string& input) {
    const std::string file = testing::TempDir() + "holomorph_fplll_" +
                             testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt";
    std::ofstream(file) << input;
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("fplll " + options + " " + file).c_str(), "r"), pclose);
    std::string output;
    for (int c; (c = std::fgetc(pipe.get())) != EOF;) output += c == '[' || c == ']' ? ' ' : static_cast<char>(c);
    std::remove(file.c_str());
    std::istringstream stream(output);
    std::vector<double> numbers;
    for (double number; stream >> number;) numbers.push_back(number);
    return Eigen::Map<const MatrixXd>(numbers.data(), rows, static_cast<Index>(numbers.size()) / rows);
  }

  static std::string text_of(const IntegerMatrix& basis) {
    std::ostringstream text;
    write(text, basis);
    return text.str();
  }
};

TEST_F(Fplll, BasesAreAsGood) {
  for (const IntegerMatrix& integers :
       {random_integers(80, 80, 1'000'000, 1), knapsack(60, 1'000'000'000'000, 2), modular_lattice(80, 4001, 3),
        modular_lattice(100, 257, 4), badly_scaled(60, 50, 10, 5), scrambled(random_integers(15, 15, 10, 6), 7)}) {
    const MatrixXd ours = reduce(integers.cast<double>()).basis;
    const MatrixXd theirs = run("-d 0.99 -e 0.501", integers.rows(), text_of(integers));
    ASSERT_EQ(theirs.cols(), ours.cols());
    EXPECT_LE(mean_defect(ours), kAsGood * mean_defect(theirs));
    EXPECT_LE(ours.colwise().norm().minCoeff(), kAsGood * theirs.colwise().norm().minCoeff());
    EXPECT_NEAR(log_volume(ours), log_volume(theirs), kOffLattice * log_volume(theirs));
  }
}

// |b_1|^2 <= (delta - 1/4)^(1 - n) of the least vector's: up to such dimensions the bases are far better than that.
TEST_F(Fplll, TheFirstColumnIsAlmostALeastVector) {
  for (const IntegerMatrix& integers :
       {random_integers(30, 30, 1000, 11), modular_lattice(32, 97, 12), knapsack(25, 1'000'000'000, 13)}) {
    const MatrixXd least = run("-a svp", integers.rows(), text_of(integers));
    const double length = reduce(integers.cast<double>()).basis.col(0).norm();
    EXPECT_GE(length, least.col(0).norm());
    EXPECT_LE(length, kAsGood * least.col(0).norm());
  }
}

TEST_F(Fplll, TheNearestPlaneIsWithinItsBoundOfTheClosestVector) {
  for (unsigned seed = 21; seed < 26; ++seed) {
    const IntegerMatrix integers = random_integers(25, 25, 1000, seed);
    const IntegerMatrix target = random_integers(25, 1, 100'000, seed + 9);
    std::ostringstream vector;
    vector << "[" << target.transpose() << "]\n";
    const MatrixXd closest = run("-a cvp", integers.rows(), text_of(integers) + vector.str());
    const ReducedBasis reduced = reduce(integers.cast<double>());
    const IntegerVector plane = integers * nearest_plane(reduced, target.cast<double>());
    const auto squared_distance = [&](const VectorXd& point) { return (target.cast<double>() - point).squaredNorm(); };
    EXPECT_GE(squared_distance(plane.cast<double>()), squared_distance(closest.col(0)));
    EXPECT_LE(squared_distance(plane.cast<double>()), reduced.R.diagonal().squaredNorm() / 4);
  }
}

}  // namespace
}  // namespace holomorph::linear
