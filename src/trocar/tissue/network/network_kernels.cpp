// Which instruction set the network's kernels use.
#include <cstdlib>
#include <cstring>

#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/network_kernels.hpp>

namespace trocar::tissue {
namespace {

bool can_run(const KernelSet* set) {
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

/// The widest runnable set not above `wish` (null: no wish).
const KernelSet* choose(const char* wish) {
  const KernelSet* sets[] = {kernels_avx512(), kernels_avx2(), kernels_sse2(), kernels_generic()};
  const char* names[] = {"avx512", "avx2", "sse2", "generic"};
  int first = 0;
  for (int i = 0; wish && i < 4; ++i)
    if (std::strcmp(wish, names[i]) == 0) first = i;
  for (int i = first; i < 4; ++i)
    if (can_run(sets[i])) return sets[i];
  return kernels_generic();
}

const KernelSet*& chosen() {
  static const KernelSet* set = choose(std::getenv("TROCAR_SIMD"));
  return set;
}

}  // namespace

const KernelSet& kernels() noexcept { return *chosen(); }

const char* simd_name() noexcept { return kernels().name; }

bool set_simd(const std::string& name) noexcept {
  for (const KernelSet* set : {kernels_generic(), kernels_sse2(), kernels_avx2(), kernels_avx512()}) {
    if (set && name == set->name && can_run(set)) {
      chosen() = set;
      return true;
    }
  }
  return false;
}

}  // namespace trocar::tissue
