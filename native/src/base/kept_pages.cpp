#include "base/kept_pages.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace holomorph {

#ifdef __linux__
namespace {

// Consecutive pages, moved by the system as one.
struct Run {
  char* begin;
  std::size_t bytes;
};

std::size_t whole_pages(std::size_t bytes) { return (bytes + kLargePage - 1) & ~(kLargePage - 1); }

// Room whose pages the system makes when they are first used.
char* new_room(std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes + kLargePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  char* const given = static_cast<char*>(memory);
  const std::size_t before =
      whole_pages(reinterpret_cast<std::uintptr_t>(given)) - reinterpret_cast<std::uintptr_t>(given);
  if (before > 0) munmap(given, before);
  if (before < kLargePage) munmap(given + before + bytes, kLargePage - before);
  advise_large_pages(given + before, bytes);
  return given + before;
}

class KeptRuns {
 public:
  /// @param ahead bytes that make_one() is to make
  void keep(std::size_t ahead) {
    const std::lock_guard lock(mutex_);
    ++keepers_;
    wanted_ += whole_pages(ahead);
  }

  // Keeps a new page, written once. @return whether more are wanted
  bool make_one() {
    constexpr std::size_t kSmallPage = 4096;  // or more: then some are written twice
    char* const room = new_room(kLargePage);
    for (std::size_t byte = 0; byte < kLargePage; byte += kSmallPage) room[byte] = 0;
    const std::lock_guard lock(mutex_);
    if (wanted_ == 0) {
      munmap(room, kLargePage);
      return false;
    }
    wanted_ -= kLargePage;
    keep_or_free({room, kLargePage});
    return wanted_ > 0;
  }

  // Whatever another computation still wants is made as it is used.
  void stop_making() {
    const std::lock_guard lock(mutex_);
    wanted_ = 0;
  }

  void stop_keeping() {
    const std::lock_guard lock(mutex_);
    if (--keepers_ > 0) return;
    for (const Run& run : kept_) munmap(run.begin, run.bytes);
    kept_.clear();
  }

  char* take(std::size_t bytes) {
    char* const room = new_room(bytes);
    const std::lock_guard lock(mutex_);
    try {
      fill(room, bytes);
    } catch (const std::bad_alloc&) {
      munmap(room, bytes);
      throw;
    }
    return room;
  }

  void give(char* memory, std::size_t bytes) noexcept {
    const std::lock_guard lock(mutex_);
    char* const end = memory + bytes;
    for (char* begin = memory; begin != end;) {
      const auto seam = seams_.upper_bound(begin);
      char* const next = seam != seams_.end() && *seam < end ? *seam : end;
      if (next != end) seams_.erase(seam);
      keep_or_free({begin, static_cast<std::size_t>(next - begin)});
      begin = next;
    }
  }

 private:
  // Moves kept pages to where there are none yet, those given last first, as far as they go.
  void fill(char* room, std::size_t bytes) {
    std::size_t filled = 0;
    while (filled < bytes && !kept_.empty()) {
      Run& last = kept_.back();
      const std::size_t part = std::min(last.bytes, bytes - filled);
      char* const to = room + filled;
      filled += part;
      if (filled < bytes) seams_.insert(room + filled);
      last.bytes -= part;
      char* const from = last.begin + last.bytes;
      if (last.bytes == 0) kept_.pop_back();
      move(from, part, to);
    }
    wanted_ -= std::min(wanted_, bytes - filled);  // the system makes the rest as it is used
  }

  void keep_or_free(const Run& run) noexcept {
    if (keepers_ > 0) {
      try {
        kept_.push_back(run);
        return;
      } catch (const std::bad_alloc&) {
        // then it goes back to the system
      }
    }
    munmap(run.begin, run.bytes);
  }

  // The pages of a run to where there are none. Should the system not move them, new ones are made there.
  static void move(char* from, std::size_t bytes, char* to) {
    if (mremap(from, bytes, bytes, MREMAP_MAYMOVE | MREMAP_FIXED, to) != MAP_FAILED) return;
    munmap(from, bytes);
    const int fixed = MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED;
    if (mmap(to, bytes, PROT_READ | PROT_WRITE, fixed, -1, 0) == MAP_FAILED) throw std::bad_alloc();
  }

  std::mutex mutex_;
  int keepers_ = 0;
  std::size_t wanted_ = 0;  // bytes that are still to be made ahead
  std::vector<Run> kept_;
  std::set<char*> seams_;  // in memory that is in use: where runs meet, as the system moves no two at once
};

KeptRuns& pages() {
  static KeptRuns& result = *new KeptRuns;  // outlives whatever is freed at the end of the program
  return result;
}

}  // namespace

void advise_large_pages(void* memory, std::size_t bytes) {
  const auto begin = reinterpret_cast<std::uintptr_t>(memory), first = (begin + kLargePage - 1) & ~(kLargePage - 1);
  const auto end = (begin + bytes) & ~(kLargePage - 1);
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

KeptPages::KeptPages(std::size_t ahead, int threads) {
  constexpr std::size_t kLeast = 8 * kLargePage;  // for less no thread is begun
  const bool makes = ahead >= kLeast && threads > 1;
  pages().keep(makes ? ahead : 0);
  if (!makes) return;
  try {
    ahead_ = std::thread([this] {
      try {
        while (!over_.load() && pages().make_one()) {
        }
      } catch (const std::bad_alloc&) {
        // whoever needs the memory will say so
      }
    });
  } catch (const std::system_error&) {
    // no more threads: pages are made as they are used
  }
}

KeptPages::~KeptPages() {
  over_ = true;
  if (ahead_.joinable()) {
    ahead_.join();
    pages().stop_making();
  }
  pages().stop_keeping();
}

void* take_pages(std::size_t bytes) { return pages().take(whole_pages(bytes)); }
void give_pages(void* memory, std::size_t bytes) noexcept {
  pages().give(static_cast<char*>(memory), whole_pages(bytes));
}

#else

void advise_large_pages(void*, std::size_t) {}
KeptPages::KeptPages(std::size_t, int) {}
KeptPages::~KeptPages() = default;
void* take_pages(std::size_t bytes) { return ::operator new(bytes, std::align_val_t(kLargePage)); }
void give_pages(void* memory, std::size_t) noexcept { ::operator delete(memory, std::align_val_t(kLargePage)); }

#endif

}  // namespace holomorph
