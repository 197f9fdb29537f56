// Which instruction set the pool's loops use.
#include <cstdlib>
#include <cstring>

#include <trocar/fluids/pool_kernels.hpp>

namespace trocar::fluids {
namespace {

bool can_run(const PoolKernels* set) {
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

const PoolKernels* choose(const char* wish) {
  const PoolKernels* sets[] = {pool_kernels_avx512(), pool_kernels_avx2(), pool_kernels_plain()};
  const char* names[] = {"avx512", "avx2", "plain"};
  int first = wish ? 2 : 0;
  for (int i = 0; wish && i < 3; ++i)
    if (std::strcmp(wish, names[i]) == 0) first = i;
  for (int i = first; i < 3; ++i)
    if (can_run(sets[i])) return sets[i];
  return pool_kernels_plain();
}

const PoolKernels*& chosen() {
  static const PoolKernels* set = choose(std::getenv("TROCAR_SIMD"));
  return set;
}

}  // namespace

const PoolKernels& pool_kernels() noexcept { return *chosen(); }

bool use_pool_kernels(const PoolKernels* kernels) noexcept {
  if (!can_run(kernels)) return false;
  chosen() = kernels;
  return true;
}

}  // namespace trocar::fluids
