// Which instruction set the pool's loops use.
#include <trocar/core/instruction_set.hpp>
#include <trocar/fluids/pool_kernels.hpp>

namespace trocar::fluids {
namespace {

const PoolKernels* choose(const char* wish) {
  const PoolKernels* sets[] = {pool_kernels_avx512(), pool_kernels_avx2(), pool_kernels_plain()};
  const char* names[] = {"avx512", "avx2", "plain"};
  return core::widest(sets, names, wish, 2);
}

const PoolKernels*& chosen() {
  static const PoolKernels* set = choose(core::wished_instruction_set());
  return set;
}

}  // namespace

const PoolKernels& pool_kernels() noexcept { return *chosen(); }

bool use_pool_kernels(const PoolKernels* kernels) noexcept {
  if (!core::can_run(kernels)) return false;
  chosen() = kernels;
  return true;
}

}  // namespace trocar::fluids
