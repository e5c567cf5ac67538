#include "solver/multigrid/wavefront.h"

#include <algorithm>
#include <limits>

namespace holomorph::solver {
namespace {

constexpr int kLeft = std::numeric_limits<int>::max();
// The fewest chunks in a segment: with fewer, too many chunks need another segment.
constexpr int kShortestSegment = 32;
// Segments for each thread: more than one, so that others can take work from a thread that comes late.
constexpr int kSegmentsPerThread = 2;

// After which chunk of the first loop a chunk may be done, given those times for the loop before; kLeft if it needs
// chunks that are not in the segment `begin` .. `end` - 1.
int ready(int chunk, const std::vector<int>& needs, const std::vector<int>& before, int begin, int end) {
  int time = before[chunk];
  for (const int c : needs) time = c < begin || c >= end ? kLeft : std::max(time, before[c]);
  return time;
}

}  // namespace

ChunkNeeds chunk_needs(const SparseRows& M, int each, int chunks, Workers& workers) {
  ChunkNeeds needs(chunks);
  run_throwing(workers, chunks, [&](int chunk) {
    const int begin = std::min(chunk * each, M.size()), end = std::min(begin + each, M.size());
    std::vector<char> found(chunks, 0);
    for (int i = begin; i < end; ++i) {
      for (const Entry& entry : M[i]) {
        const int need = entry.column / kChunkRows;
        if (found[need] == 0) needs[chunk].push_back(need);
        found[need] = 1;
      }
    }
  });
  return needs;
}

ChunkNeeds symmetrised(const ChunkNeeds& needs) {
  ChunkNeeds result = needs;
  for (int chunk = 0; chunk < static_cast<int>(needs.size()); ++chunk) {
    for (const int c : needs[chunk]) {
      const bool known = std::find(needs[c].begin(), needs[c].end(), chunk) != needs[c].end();
      if (!known) result[c].push_back(chunk);
    }
  }
  return result;
}

Wavefront::Wavefront(int chunks, const std::vector<ChunkNeeds>& needs, int threads)
    : segments_(threads * std::min(kSegmentsPerThread, chunks / (kShortestSegment * threads))),
      left_(needs.size() + 1) {
  std::vector<std::vector<int>> time(left_.size(), std::vector<int>(chunks, kLeft));
  const auto count = static_cast<std::int64_t>(segments_.size());
  for (std::int64_t s = 0; s < count; ++s) {
    const int begin = static_cast<int>(chunks * s / count), end = static_cast<int>(chunks * (s + 1) / count);
    std::vector<std::vector<Step>> at(end - begin);
    for (int loop = 0; loop < static_cast<int>(time.size()); ++loop) {
      for (int c = begin; c < end; ++c) {
        // A chunk of a later loop follows, in its segment, as soon as the last chunk that it needs is done.
        time[loop][c] = loop == 0 ? c : ready(c, needs[loop - 1][c], time[loop - 1], begin, end);
        if (time[loop][c] != kLeft) at[time[loop][c] - begin].push_back({loop, c});
      }
    }
    for (const auto& steps : at) segments_[s].insert(segments_[s].end(), steps.begin(), steps.end());
  }
  for (std::size_t loop = 0; loop < time.size(); ++loop) {
    for (int c = 0; c < chunks; ++c) {
      if (time[loop][c] == kLeft) left_[loop].push_back(c);
    }
  }
}

}  // namespace holomorph::solver
