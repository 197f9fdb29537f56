#include <trocar/core/hash.hpp>

// gcc 12's own AVX-512 intrinsics leave a register "undefined" on purpose and then warn about it (-march=native).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

namespace trocar::core {

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed) noexcept {
  return XXH3_64bits_withSeed(data, size, seed);
}

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace trocar::core
