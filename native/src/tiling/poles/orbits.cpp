#include "tiling/poles/orbits.h"

#include <algorithm>

namespace holomorph::tiling {

std::vector<int> with_images(std::vector<int> vertices, const Mirror* mirror) {
  if (!mirror) return vertices;
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (const int image = mirror->image[vertices[i]]; image >= 0 && image != vertices[i]) vertices.push_back(image);
  }
  return vertices;
}

MatrixXcd symmetric_residues(const std::vector<int>& poles, const Mirror& mirror) {
  const auto count = static_cast<Index>(poles.size());
  MatrixXcd real(count, 0), imaginary(count, 0);
  for (Index i = 0; i < count; ++i) {
    const Index size = orbit_size(poles, i, &mirror);
    if (size == 0) continue;
    real.conservativeResize(Eigen::NoChange, real.cols() + 1);
    real.rightCols(1).setZero();
    // Real parts of a pair are equal, imaginary parts opposite. A pole on the plane has a real residue.
    real.col(real.cols() - 1).segment(i, size).setConstant(1 / static_cast<double>(size));
    if (size == 1) continue;
    imaginary.conservativeResize(Eigen::NoChange, imaginary.cols() + 1);
    imaginary.rightCols(1).setZero();
    imaginary.col(imaginary.cols() - 1).segment(i, 2) << Complex(0, 1), Complex(0, -1);
  }
  const Index free = std::max<Index>(0, real.cols() - 1);  // the last orbit takes the rest of the real parts
  MatrixXcd all(count, free + imaginary.cols());
  all << real.leftCols(free).colwise() - real.rightCols(1).rowwise().sum(), imaginary;
  return all;
}

Index first_to_last(MeromorphicForm& form, const Mirror* mirror) {
  const Index size = orbit_size(form.poles, 0, mirror);
  std::rotate(form.poles.begin(), form.poles.begin() + size, form.poles.end());
  std::rotate(form.residues.begin(), form.residues.begin() + size, form.residues.end());
  return size;
}

MeromorphicForm without_last(MeromorphicForm form, Index size, bool closed) {
  const Index k = form.residues.size() - size;
  const Complex last = form.residues.tail(size).sum();
  form.poles.resize(k);
  form.residues.conservativeResize(k);
  // On a closed surface residues sum to 0: what is removed is shared by the rest.
  if (closed) form.residues.array() += last / static_cast<double>(k);
  return form;
}

MeromorphicForm joined(MeromorphicForm form, int vertex, Complex residue, bool closed, const Mirror* mirror) {
  const Index k = form.residues.size();
  const bool pair = mirror && !mirror->is_on_plane(vertex);
  const Complex sum = pair ? 2 * residue.real() : residue;
  if (closed && k > 0) form.residues.array() -= sum / static_cast<double>(k);
  form.poles.push_back(vertex);
  if (pair) form.poles.push_back(mirror->image[vertex]);
  form.residues.conservativeResize(std::ssize(form.poles));
  form.residues[k] = closed && k == 0 ? 0 : residue;
  if (pair) form.residues[k + 1] = std::conj(residue);
  return form;
}

}  // namespace holomorph::tiling
