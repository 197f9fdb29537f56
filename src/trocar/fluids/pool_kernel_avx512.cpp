// The pool's loops for avx512 (see pool_kernel.inl).
#define TROCAR_POOL_KERNELS pool_kernels_avx512
#define TROCAR_POOL_NAME "avx512"
#if defined(__AVX512F__)
#include "pool_kernel.inl"
#else
#include <trocar/fluids/pool_kernels.hpp>
namespace trocar::fluids {
const PoolKernels* TROCAR_POOL_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::fluids
#endif
