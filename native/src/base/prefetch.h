// Asking for memory ahead of its use.
#pragma once

namespace holomorph {

/// Advice to the processor to fetch what lies at `address`, which may be any: asking never fails.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
#endif
}

/// For what is used much later: it need not take the place of what is used now in the cache next to the processor.
inline void prefetch_for_later([[maybe_unused]] const void* address) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address, 0, 2);
#endif
}

}  // namespace holomorph
