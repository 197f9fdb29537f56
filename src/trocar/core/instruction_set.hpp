// Which of several compilations of the same loops, one for each instruction set, this machine runs.
//
//   const Loops* sets[] = {loops_avx512(), loops_avx2(), loops_plain()};            // null where it was not compiled
//   const char* names[] = {"avx512", "avx2", "plain"};                              // the widest first
//   const Loops* set = core::widest(sets, names, core::wished_instruction_set(), 0);
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace trocar::core {

/// Of loops with a `name` of their instruction set. What is called neither avx2 nor avx512 runs everywhere.
template <class Loops>
bool can_run(const Loops* set) noexcept {
  if (!set) return false;
#if defined(__x86_64__)
  if (std::strcmp(set->name, "avx2") == 0) return __builtin_cpu_supports("avx2");
  if (std::strcmp(set->name, "avx512") == 0) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  }
#endif
  return true;
}

/// What the environment variable TROCAR_SIMD names; null: no wish.
inline const char* wished_instruction_set() noexcept { return std::getenv("TROCAR_SIMD"); }

/// The widest runnable one that is not above `wish` (null: no wish); the last one, if none is.
/// @param sets, names  the widest first
/// @param unknown      place of the widest one that is allowed where `wish` is none of the names
template <class Loops, std::size_t N>
const Loops* widest(const Loops* const (&sets)[N], const char* const (&names)[N], const char* wish,
                    std::size_t unknown) noexcept {
  std::size_t first = wish ? unknown : 0;
  for (std::size_t i = 0; wish && i < N; ++i)
    if (std::strcmp(wish, names[i]) == 0) first = i;
  for (std::size_t i = first; i < N; ++i)
    if (can_run(sets[i])) return sets[i];
  return sets[N - 1];
}

}  // namespace trocar::core
