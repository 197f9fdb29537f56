// Which instruction set the network's kernels use.
#include <trocar/core/instruction_set.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/network_kernels.hpp>

namespace trocar::tissue {
namespace {

const KernelSet* choose(const char* wish) {
  const KernelSet* sets[] = {kernels_avx512(), kernels_avx2(), kernels_sse2(), kernels_generic()};
  const char* names[] = {"avx512", "avx2", "sse2", "generic"};
  return core::widest(sets, names, wish, 0);
}

const KernelSet*& chosen() {
  static const KernelSet* set = choose(core::wished_instruction_set());
  return set;
}

}  // namespace

const KernelSet& kernels() noexcept { return *chosen(); }

const char* simd_name() noexcept { return kernels().name; }

bool set_simd(const std::string& name) noexcept {
  for (const KernelSet* set : {kernels_generic(), kernels_sse2(), kernels_avx2(), kernels_avx512()}) {
    if (set && name == set->name && core::can_run(set)) {
      chosen() = set;
      return true;
    }
  }
  return false;
}

}  // namespace trocar::tissue
