// Leaves out what no surface can have: wild vertices and faces that are not usable.
#pragma once

#include <string>
#include <vector>

#include "base/workers.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// Checks of single polygons, before anything walks the mesh.

/// Refuses a mesh without faces, offsets that do not fit, too many elements for 32 bits. @throws InvalidMesh
void check_layout(const Polygons& polygons);
void check_layout(const GivenPolygons& polygons);

/// What keeps a face from being mapped, however the mesh is cut.
enum class FaceFault { kNone, kNoSuchVertex, kNotFinite, kFewVertices };

/// kNotFinite stands for coordinates beyond kLargest, too. @pre check_layout has passed
FaceFault fault_of_face(const Polygons& polygons, int face);
FaceFault fault_of_face(const GivenPolygons& polygons, int face);

/// Returns what `check_polygons` says about a face that it refuses.
std::string fault_text(const Polygons& polygons, int face);
std::string fault_text(const GivenPolygons& polygons, int face);

/// Refuses bad polygons, naming the first bad element. Faces: none at all, offsets that do not fit, fewer than 3
/// corners, a negative or too large index, a vertex twice. Positions: NaN, infinite or beyond kLargest, or all below
/// kSmallest. Also too many elements for 32 bits.
/// @throws InvalidMesh
void check_polygons(const Polygons& polygons, Workers& workers);
void check_polygons(const GivenPolygons& polygons, Workers& workers);

/// Returns the wild vertices, ascending: those of faces that reach from the bulk of the mesh to beyond kWild times its
/// size. The bulk are the corners about their median, half of them at least, up to the first gap by that factor. A part
/// that lies there as a whole has none; nor has a mesh all of whose faces would have some.
/// @pre check_layout has passed; vertices that do not exist or are beyond kLargest do not count
/// Cost: O(#V) where all vertices lie near a sample of them, else O(#C log #C).
std::vector<int> wild_vertices(const Polygons& polygons);
std::vector<int> wild_vertices(const GivenPolygons& polygons);

/// The factor by which a vertex is wild: the area of the rest is beyond the digits of that of its faces.
inline constexpr double kWild = 1e9;

/// Faces that are left out for one reason.
struct RefusedFaces {
  std::vector<int> faces;  ///< ascending
  std::string reason;      ///< names the first bad element
};

struct UsableFaces {
  PolygonPart part;
  std::vector<RefusedFaces> refused;  ///< the others, by reasons
};

/// Keeps the faces with at least three different vertices, all of which exist and have finite coordinates, none of them
/// wild (wild_vertices).
/// @pre check_layout has passed
UsableFaces usable_faces(GivenPolygons polygons);
UsableFaces usable_faces(Polygons polygons);

/// Refuses a mesh with a wild vertex, naming the first. @throws InvalidMesh
void refuse_wild_vertices(const Polygons& polygons);
void refuse_wild_vertices(const GivenPolygons& polygons);

}  // namespace holomorph::mesh
