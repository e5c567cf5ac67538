#include "planted_defects.h"

#include <thread>

// The optimiser is not to see through what it could take away. Visible, whatever the rest of the build hides.
#define PLANTED __attribute__((noinline, visibility("default")))

extern "C" {

PLANTED int heap_overflow(int length) {
  volatile int* const numbers = new int[length]();
  const int beyond = numbers[length];
  delete[] numbers;
  return beyond;
}

PLANTED int signed_overflow(int number) { return number + 1; }

// Many, as what is left of a pointer in a register or on the stack lets a block pass for one that is in use.
PLANTED void leak() {
  [[maybe_unused]] static char* volatile forgotten;
  for (int i = 0; i < 100; ++i) forgotten = new char[1000];
  forgotten = nullptr;
}

PLANTED int data_race() {
  int number = 0;
  volatile int* const shared = &number;
  const auto count = [shared] {
    for (int i = 0; i < 1000; ++i) *shared = *shared + 1;
  };
  std::thread other(count);
  count();
  other.join();
  return number;
}
}
