// Prefetch of memory that is read soon.
#pragma once

namespace holomorph {

/// Advice to the processor to fetch what lies at `address`, which may be any: asking never fails.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
#endif
}

}  // namespace holomorph
