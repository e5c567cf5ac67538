#include "solver/weight_rests.h"

namespace holomorph::solver {

Array<float> weight_rests(const Laplacian& L, const SparseRows& A, Workers& workers, Execution& execution) {
  const int *const start = L.starts.data(), *const column = L.columns.data();
  const double* const weight = L.weights.data();
  Array<float> rests(A.rows.entries().size());
  float* const rest = rests.data();
  for_set_up_chunks(workers, A.size(), execution, [&](int, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      int e = start[i];  // columns ascend in both
      for (int k = A.place[i].begin; k < A.place[i].end; ++k, ++e) {
        const Entry& entry = A.rows.entries()[k];
        while (column[e] != entry.column) ++e;
        rest[k] = static_cast<float>(-weight[e] - static_cast<double>(entry.weight));
      }
    }
  });
  return rests;
}

Laplacian laplacian_of(const CycleLevel& finest, const Array<float>& rests) {
  const std::size_t size = finest.A.entries().size() + finest.rows;
  Laplacian L{Array<int>(finest.rows + std::size_t{1}), Array<int>(size), Array<double>(size)};
  const auto for_rows = [&finest](const auto& body) {
    for (int chunk = 0; chunk < finest.chunks; ++chunk) finest.A.for_rows(chunk, body);
  };
  L.starts[0] = 0;
  for_rows([&L](int i, const Entry*, int length) { L.starts[i + 1] = length + 1; });
  for (int i = 0; i < finest.rows; ++i) L.starts[i + 1] += L.starts[i];
  for_rows([&](int i, const Entry* entries, int length) {
    const float* const rest = rests.data() + (entries - finest.A.entries().data());
    int diagonal = L.starts[i];
    while (diagonal < L.starts[i] + length && entries[diagonal - L.starts[i]].column < i) ++diagonal;
    double sum = 0;
    for (int k = 0; k < length; ++k) {
      const int e = L.starts[i] + k + (L.starts[i] + k >= diagonal);
      const double weight = static_cast<double>(entries[k].weight) + static_cast<double>(rest[k]);
      L.columns[e] = entries[k].column;
      L.weights[e] = -weight;
      sum += weight;
    }
    L.columns[diagonal] = i;
    L.weights[diagonal] = sum;
  });
  return L;
}

}  // namespace holomorph::solver
