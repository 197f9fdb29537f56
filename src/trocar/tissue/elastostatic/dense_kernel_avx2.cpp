// Dense elimination's loops for avx2 (see dense_kernel.inl).
#define TROCAR_DENSE_KERNELS dense_kernels_avx2
#define TROCAR_DENSE_NAME "avx2"
#define TROCAR_DENSE_LANE 4
#define TROCAR_DENSE_LANES 2
#define TROCAR_DENSE_COLUMNS 4
#if defined(__AVX2__)
#include "dense_kernel.inl"
#else
#include <trocar/tissue/elastostatic/dense_kernels.hpp>
namespace trocar::tissue {
const DenseKernels* TROCAR_DENSE_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
