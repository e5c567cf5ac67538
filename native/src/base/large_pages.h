// Memory on large pages.
#pragma once

#include <cstddef>

namespace holomorph {

/// Page size of large arrays in bytes, where the system has it.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// Advises the system to use large pages where whole ones lie in the memory. This saves misses of the address cache,
/// and 511 of 512 page faults. Has no effect where the system refuses.
void advise_large_pages(void* memory, std::size_t bytes);

/// Allocates uninitialised memory at a multiple of kLargePage, which goes back to the system as soon as it is freed.
/// The heap would keep it, and a computation takes and frees many large arrays of different sizes.
/// @throws std::bad_alloc
void* take_large_pages(std::size_t bytes);

/// Frees what take_large_pages(bytes) returned.
void free_large_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace holomorph
