// Structures that were solved for: forms, and maps of disks to the plane.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "choice/any_structure.h"
#include "flat/dirichlet_problem.h"
#include "structure/solved.h"

namespace holomorph::choice {

/// Forms to mix, log maps among them, or the round map of a disk with one pole. Solved for once, and shared.
class Forms final : public AnyStructure {
 public:
  Forms(MapKind kind, PartPointer part, std::shared_ptr<structure::Solved> solved);

  const std::shared_ptr<structure::Solved>& solved() const { return solved_; }
  int form_count() const override;
  bool is_real() const override;
  std::vector<int> seams(Execution& execution) override;
  std::vector<int> poles() const override;
  void prepare_uv(Execution& execution) override;
  Eigen::VectorXcd balanced_coefficients(Execution& execution) override;
  uv::UvArray uv(const Eigen::VectorXcd& coefficients, Execution& execution) override;
  uv::Kept kept(const Eigen::VectorXcd& coefficients, Execution& execution) override;

 private:
  std::shared_ptr<structure::Solved> solved_;
  std::mutex mutex_;
  std::optional<Eigen::VectorXcd> balanced_;
};

/// One fixed map of a disk to the plane.
class PlaneStructure final : public AnyStructure {
 public:
  /// @param modulus height over width of a rectangle, where its bounds were narrowed; 0: the map's own
  PlaneStructure(MapKind kind, PartPointer part, std::shared_ptr<const flat::PlaneMap> map, double modulus = 0);

  const std::shared_ptr<const flat::PlaneMap>& map() const { return map_; }
  int form_count() const override { return 0; }
  bool is_real() const override { return false; }
  std::vector<int> seams(Execution&) override { return {}; }
  std::vector<int> poles() const override { return {}; }
  void prepare_uv(Execution&) override {}
  Eigen::VectorXcd balanced_coefficients(Execution&) override { return {}; }
  uv::UvArray uv(const Eigen::VectorXcd& coefficients, Execution& execution) override;
  uv::Kept kept(const Eigen::VectorXcd& coefficients, Execution& execution) override;

 private:
  std::shared_ptr<const flat::PlaneMap> map_;
  double modulus_;
};

}  // namespace holomorph::choice
