// Prefetch of memory that is read soon.
#pragma once

namespace holomorph {

/// Advises the processor to fetch what lies at `address`. Any address will do: the advice never fails.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
#endif
}

}  // namespace holomorph
