// Dense elimination's loops for avx512 (see dense_kernel.inl).
#define TROCAR_DENSE_KERNELS dense_kernels_avx512
#define TROCAR_DENSE_NAME "avx512"
#define TROCAR_DENSE_LANE 8
#if defined(__AVX512F__)
#include "dense_kernel.inl"
#else
#include <trocar/tissue/elastostatic/dense_kernels.hpp>
namespace trocar::tissue {
const DenseKernels* TROCAR_DENSE_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
