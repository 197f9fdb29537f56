// The elastostatic solver's loops for avx2 (see field_kernel.inl).
#define TROCAR_FIELD_KERNELS field_kernels_avx2
#define TROCAR_FIELD_NAME "avx2"
#if defined(__AVX2__)
#include "field_kernel.inl"
#else
#include <trocar/tissue/elastostatic/field_kernels.hpp>
namespace trocar::tissue {
const FieldKernels* TROCAR_FIELD_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
