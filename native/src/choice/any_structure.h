// The structure of a connected part of any kind, and the maps that it gives by itself.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/resource_pool.h"
#include "choice/part.h"
#include "choice/tilers.h"
#include "flat/dirichlet_problem.h"
#include "structure/primal_forms.h"
#include "uv/quality.h"
#include "uv/turned_functions.h"

namespace holomorph::choice {

/// What the maps of a structure are: combinations of holomorphic forms, a strip of an annulus, with poles; or one fixed
/// map of a disk, round, to a rectangle, or with a free boundary.
enum class MapKind { kForms, kStrip, kLog, kDisk, kRectangle, kFlat };

/// A connected piece of a part, with indices of its elements there.
struct Piece {
  PartPointer part;  ///< its own
  std::vector<int> vertex_index, face_index, corner_index;
  int name = 0;                   ///< of its polygons, as flat::names_of_pieces
  std::optional<uv::UvArray> uv;  ///< #C x 2 of its islands; none without any
  double cost = 0;                ///< of these, see uv/appearance.h; infinite without any
};

class AnyStructure;

/// What is known of the pieces of a part, and kept for other dials. Several threads may use it at once.
struct KnownPieces {
  /// Those that were solved, by their polygons; the structure is of the piece with its windows closed.
  Newest<std::vector<int>, std::pair<PartPointer, std::shared_ptr<AnyStructure>>> solved{256};
  /// The part cut open where few see it, and how far that is seen, by whether it is to be upright.
  Newest<bool, std::optional<std::pair<Piece, double>>> cut{2};
};

/// A structure with the maps that it gives. Several threads may use it at once.
class AnyStructure {
 public:
  virtual ~AnyStructure() = default;

  MapKind kind() const { return kind_; }
  const PartPointer& part() const { return part_; }
  /// The triangles on which its maps are measured: of the part, or with diagonals flipped away from poles.
  const std::shared_ptr<const mesh::Surface>& triangulation() const { return triangulation_; }
  /// The tilings of the part, whose poles and cones are kept.
  Tilers& tilers() { return tilers_; }
  KnownPieces& pieces() { return pieces_; }

  /// How many forms there are to mix: coefficients of a map.
  virtual int form_count() const = 0;
  /// Whether coefficients are real, so that boundaries stay straight.
  virtual bool is_real() const = 0;
  /// The edges of `triangulation` where maps jump.
  virtual std::vector<int> seams(Execution& execution) = 0;
  /// Vertices around which maps change by a residue, or the centre of a round one.
  virtual std::vector<int> poles() const = 0;
  /// Solves for what maps are made of, ahead.
  virtual void prepare_uv(Execution& execution) = 0;
  /// Those of the map that is shown first.
  virtual Eigen::VectorXcd balanced_coefficients(Execution& execution) = 0;
  /// #C x 2. @throws SolverError where a UV is not finite
  virtual uv::UvArray uv(const Eigen::VectorXcd& coefficients, Execution& execution) = 0;
  /// What evening keeps of such a map.
  virtual uv::Kept kept(const Eigen::VectorXcd& coefficients, Execution& execution) = 0;

  /// The quality of a map, with a free boundary also of how much it covers itself. @param uv #C x 2
  uv::Quality quality(const uv::UvArray& uv, Execution& execution) const;

 protected:
  AnyStructure(MapKind kind, PartPointer part, std::shared_ptr<const mesh::Surface> triangulation)
      : kind_(kind), part_(std::move(part)), triangulation_(std::move(triangulation)), tilers_(part_) {}

 private:
  MapKind kind_;
  PartPointer part_;
  std::shared_ptr<const mesh::Surface> triangulation_;
  Tilers tilers_;
  KnownPieces pieces_;
};
using StructurePointer = std::shared_ptr<AnyStructure>;

// Structures that were solved for: forms, and maps of disks to the plane.

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
