// The structure of a connected part of any kind, and the maps that it gives by itself.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "choice/part.h"
#include "choice/tilers.h"
#include "uv/quality.h"
#include "uv/turned_functions.h"

namespace holomorph::choice {

/// What the maps of a structure are: combinations of holomorphic forms, a strip of an annulus, with poles; or one fixed
/// map of a disk, round, to a rectangle, or with a free boundary.
enum class MapKind { kForms, kStrip, kLog, kDisk, kRectangle, kFlat };

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
};
using StructurePointer = std::shared_ptr<AnyStructure>;

}  // namespace holomorph::choice
