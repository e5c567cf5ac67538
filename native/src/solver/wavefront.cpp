#include "solver/wavefront.h"

#include <limits>

namespace holomorph::solver {
namespace {

constexpr int kLeft = std::numeric_limits<int>::max();
// Fewer chunks leave too many between two segments.
constexpr int kShortestSegment = 32;
// So that a thread which comes late leaves work to the others.
constexpr int kSegmentsPerThread = 2;

// Equally many for each thread; none where that would make them too short.
int segments(int chunks, int threads) {
  return threads * std::min(kSegmentsPerThread, chunks / (kShortestSegment * threads));
}

// After which chunk of the first loop a chunk may be done, given those times for the loop before; kLeft if it needs
// chunks that are not in the segment `begin` .. `end` - 1.
int ready(int chunk, const std::vector<int>& needs, const std::vector<int>& before, int begin, int end) {
  int time = before[chunk];
  for (const int c : needs) time = c < begin || c >= end ? kLeft : std::max(time, before[c]);
  return time;
}

}  // namespace

Wavefront::Wavefront(int chunks, const std::vector<const Needs*>& needs, int threads)
    : segments_(segments(chunks, threads)), left_(needs.size() + 1) {
  std::vector<std::vector<int>> time(left_.size(), std::vector<int>(chunks, kLeft));
  const auto count = static_cast<std::int64_t>(segments_.size());
  for (std::int64_t s = 0; s < count; ++s) {
    const int begin = static_cast<int>(chunks * s / count), end = static_cast<int>(chunks * (s + 1) / count);
    std::vector<std::vector<Step>> at(end - begin);
    for (int loop = 0; loop < static_cast<int>(time.size()); ++loop) {
      for (int c = begin; c < end; ++c) {
        time[loop][c] = loop == 0 ? c : ready(c, (*needs[loop - 1])[c], time[loop - 1], begin, end);
        if (time[loop][c] == kLeft) continue;
        const int next = time[loop][c] + 1;
        at[time[loop][c] - begin].push_back({loop, c, next < end ? next : kNone});
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
