// Which instruction set the elastostatic solver's loops use.
#include <trocar/core/instruction_set.hpp>
#include <trocar/tissue/elastostatic/field_kernels.hpp>

namespace trocar::tissue {
namespace {

const FieldKernels* choose(const char* wish) {
  const FieldKernels* sets[] = {field_kernels_avx512(), field_kernels_avx2(), field_kernels_plain()};
  const char* names[] = {"avx512", "avx2", "plain"};
  return core::widest(sets, names, wish, 2);
}

const FieldKernels*& chosen() {
  static const FieldKernels* set = choose(core::wished_instruction_set());
  return set;
}

}  // namespace

const FieldKernels& field_kernels() noexcept { return *chosen(); }

bool use_field_kernels(const FieldKernels* kernels) noexcept {
  if (!core::can_run(kernels)) return false;
  chosen() = kernels;
  return true;
}

}  // namespace trocar::tissue
