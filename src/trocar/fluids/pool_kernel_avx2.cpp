// The pool's loops for avx2 (see pool_kernel.inl).
#define TROCAR_POOL_KERNELS pool_kernels_avx2
#define TROCAR_POOL_NAME "avx2"
#if defined(__AVX2__)
#include "pool_kernel.inl"
#else
#include <trocar/fluids/pool_kernels.hpp>
namespace trocar::fluids {
const PoolKernels* TROCAR_POOL_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::fluids
#endif
