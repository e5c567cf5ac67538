// Poles that lie as the mirror image of a surface does: in pairs, and on the plane.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/triangle_tree.h"
#include "tiling/greens/pole_basis.h"
#include "tiling/poles/meromorphic_form.h"

namespace holomorph::tiling {

/// A form is its own mirror image, u -> -u and v -> v, if the image p' of each pole p is a pole with the residue
/// conj(r). The reflection takes dz to its conjugate and turns circles the other way.
struct Mirror {
  mesh::MirrorPlane plane;
  std::vector<int> image;  ///< #V: the vertex at the mirror image of a vertex; itself near the plane; -1: none

  bool is_on_plane(int vertex) const { return image[vertex] == vertex; }
};

/// Finds the mirror of a closed surface of genus 0 that is its own mirror image up to a small distance, see
/// mesh::mirror_plane; none for others. A vertex and its image are each the vertex nearest to the reflection of the
/// other.
std::optional<Mirror> mirror(const PoleBasis& basis);

/// Moves poles of a level to the mirror of its surface, where poles are allowed. A pole on the plane goes to the nearby
/// vertex nearest to the plane. Of a pair, the second goes to the vertex nearest to the image of the first.
/// @param level_poles vertices of the level, those of a pair one after the other
/// @param allowed #V of the surface: may a pole be there; empty: anywhere
/// @param poles the same of the surface; changed
Mirror mirror_of_poles(const Mirror& on_level, const std::vector<int>& level_poles, const PoleBasis& basis,
                       const std::vector<char>& allowed, std::vector<int>& poles);

/// Number of poles in the orbit that begins at index i: 2 for the first of a pair, 0 for the second, 1 for a single
/// pole. @param mirror null: all are alone
Index orbit_size(const std::vector<int>& poles, Index i, const Mirror* mirror);

/// Returns the vertices and their images. @param mirror null: every pole is an orbit, here and below
std::vector<int> with_images(std::vector<int> vertices, const Mirror* mirror);

/// Returns a real basis, #poles x n, of the residues that are their own mirror image and sum to 0.
MatrixXcd symmetric_residues(const std::vector<int>& poles, const Mirror& mirror);

/// Moves the first orbit to the end of the lists. @return its size
Index first_to_last(MeromorphicForm& form, const Mirror* mirror);

/// Removes the last `size` poles; the others share their residues where the sum has to be 0.
MeromorphicForm without_last(MeromorphicForm form, Index size, bool closed);

/// Adds a pole, and its image; the others share the opposite of its residue where the sum has to be 0.
MeromorphicForm joined(MeromorphicForm form, int vertex, Complex residue, bool closed, const Mirror* mirror);

}  // namespace holomorph::tiling
