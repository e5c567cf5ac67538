// Poles of a form that come and go together: each by itself, or with a mirror a pole on its plane, or a pair of images.
#pragma once

#include <vector>

#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/mirror.h"

namespace holomorph::tiling {

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
