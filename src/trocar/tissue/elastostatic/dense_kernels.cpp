// Which instruction set dense elimination uses.
#include <trocar/core/instruction_set.hpp>
#include <trocar/tissue/elastostatic/dense_kernels.hpp>

namespace trocar::tissue {
namespace {

const DenseKernels* choose_dense(const char* wish) {
  const DenseKernels* sets[] = {dense_kernels_avx512(), dense_kernels_avx2(), dense_kernels_plain()};
  const char* names[] = {"avx512", "avx2", "plain"};
  return core::widest(sets, names, wish, 2);
}

const DenseKernels*& chosen_dense() {
  static const DenseKernels* set = choose_dense(core::wished_instruction_set());
  return set;
}

}  // namespace

const DenseKernels& dense_kernels() noexcept { return *chosen_dense(); }

bool use_dense_kernels(const DenseKernels* kernels) noexcept {
  if (!core::can_run(kernels)) return false;
  chosen_dense() = kernels;
  return true;
}

}  // namespace trocar::tissue
