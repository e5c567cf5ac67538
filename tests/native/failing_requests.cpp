// Loaded before all other libraries, by tests/core/base/test_faults.py: lets one request for memory, or for a
// thread, fail.
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <initializer_list>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

std::atomic<long> memory{-1}, threads{-1};  // requests granted before the one that fails; below 0: none fails

bool fails(std::atomic<long>& left) { return left.load() >= 0 && left.fetch_sub(1) == 0; }

// Whether the library, or one that computes for it, asks. Python and NumPy have failures of their own, and GNU's OpenMP
// ends the process.
bool is_ours(const void* caller) {
  Dl_info info;
  if (dladdr(caller, &info) == 0) return false;
  for (const char* name : {"_native", "libstdc++", "cholmod", "suitesparse"}) {
    if (std::strstr(info.dli_fname, name) != nullptr) return true;
  }
  return false;
}

// A smaller request may be one of pybind11 for the record of a Python object: where it fails, the object is freed
// twice.
constexpr std::size_t kLeast = 64;

bool refuses(std::size_t size, const void* caller) {
  if (memory.load() < 0 || size < kLeast || !is_ours(caller) || !fails(memory)) return false;
  errno = ENOMEM;
  return true;
}

}  // namespace

extern "C" {
void fail_memory_after(long requests) { memory = requests; }
void fail_thread_after(long requests) { threads = requests; }
/// Below 0 when the request has come that failed.
long memory_requests_left() { return memory; }

#define REFUSES(size) refuses(size, __builtin_return_address(0))
void* malloc(std::size_t size) { return REFUSES(size) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return REFUSES(count * size) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) { return REFUSES(size) ? nullptr : __libc_realloc(old, size); }
void* memalign(std::size_t alignment, std::size_t size) {
  return REFUSES(size) ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  *result = memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
  static const auto next = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  return fails(threads) ? EAGAIN : next(thread, attributes, run, argument);
}
}
