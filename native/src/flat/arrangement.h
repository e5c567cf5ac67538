// The maps of a mesh's parts side by side in the UV plane, at one median density.
//
// Tilings come first, from (0, 0) on. They are turned by quarters and moved by whole units alone: by anything else a
// texture would break off at their seams. Other maps fill the UV square where there is no tiling, else they lie to the
// right of the tilings.
#pragma once

#include <array>
#include <vector>

#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::flat {

// Rectangles side by side on shelves.

using Extent = std::array<double, 2>;  // along u and v

struct Shelves {
  std::vector<Extent> corners;  ///< the lower left corner of each rectangle
  Extent whole{};               ///< width and height of all
};

/// Places rectangles by falling height, ties by index, from left to right. A new row begins where the width is used up;
/// its height is that of its first one. @param gap between neighbours and between rows. Cost: n log n
Shelves on_shelves(const std::vector<Extent>& sizes, double width, double gap);

struct Packing {
  std::vector<Extent> corners;  ///< the lower left corner of each rectangle
  double side = 0;              ///< of the square in which they lie, centred
};

/// Places rectangles in the smallest square that one of a fixed set of widths gives. Nothing is turned, so that
/// straight boundaries stay level. Points lie at 0.
/// @param margin distance of neighbours, as a share of the side; less where so many parts would have no room
Packing pack(const std::vector<Extent>& sizes, double margin);

/// The margin, or the largest one for which this number of parts has room.
double fitting_margin(double margin, std::size_t count);

/// Times the root of its own area that a map is wide: single precision has no room for others then.
inline constexpr double kScattered = 300;

/// A map that is laid beside others.
struct Laid {
  const mesh::Surface* surface = nullptr;
  double area = 0;                   ///< of the surface
  Eigen::Map<const uv::UvArray> uv;  ///< #C x 2
  double density = 0;                ///< median UV area per area of the surface
  bool is_tiled = false;
  int turns = 1;
  const int* corner_index = nullptr;  ///< #C corners of the mesh; null: its own
};

/// How maps lie in the UV plane.
struct Arrangement {
  double density = 1;     ///< factor of UV lengths of other maps than tilings, about the middle of the UV square
  double rotation = 0;    ///< radians, counter-clockwise, of other maps than tilings
  double margin = 0.02;   ///< least distance of parts, in sides of the square that they are packed into
  double per_length = 0;  ///< UV length for a length on the surface, at density 1; 0 fills the UV square
  int quarters = 0;       ///< turns of tilings by 90 degrees, counter-clockwise
};

/// Maps packed into a square, each scaled until a UV unit is a unit of length where its density is the median one; to a
/// point where it has no area, such as one whose coefficients are 0.
class Square {
 public:
  Square(const std::vector<Laid>& maps, const Arrangement& arrangement, Workers& workers);

  /// `Arrangement::per_length` with which the maps fill the UV square; infinite where none has an area.
  double filling() const;
  /// Part of the square that the maps cover, where they do not lie over themselves.
  double used() const;
  /// UV length for a length on the surface, where the density is the median one; 0 for maps without area.
  double per_length() const;
  /// Widths and heights of the maps.
  const std::vector<Extent>& sizes() const { return sizes_; }

  /// Writes the maps into UVs of the mesh. @param maps of the square. @param placed two numbers for each corner
  void write(const std::vector<Laid>& maps, double* placed, Workers& workers) const;

 private:
  Arrangement arrangement_;
  std::vector<uv::Frame> frames_;
  std::vector<double> scales_;
  std::vector<Extent> sizes_;
  Packing packed_;
};

/// Rounds to multiples of a power of two that single precision holds, so that differences by whole numbers stay exact.
void round_to_grid(Eigen::Ref<uv::UvArray> uv);

/// #C x 2 UVs of a mesh from the maps of its parts; zeros at corners without a map. Beside a tiling all values are
/// exact in single precision. @param corners of the mesh
uv::UvArray arranged(const std::vector<Laid>& maps, int corners, const Arrangement& arrangement, Workers& workers);

/// The length on the surface of a UV unit of `arranged` maps, where the density is the median one; 0 for maps without
/// area.
double unit_length(const std::vector<Laid>& maps, const Arrangement& arrangement, Workers& workers);

}  // namespace holomorph::flat
