// The elastostatic solver's loops for avx512 (see field_kernel.inl).
#define TROCAR_FIELD_KERNELS field_kernels_avx512
#define TROCAR_FIELD_NAME "avx512"
#if defined(__AVX512F__)
#include "field_kernel.inl"
#else
#include <trocar/tissue/elastostatic/field_kernels.hpp>
namespace trocar::tissue {
const FieldKernels* TROCAR_FIELD_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
