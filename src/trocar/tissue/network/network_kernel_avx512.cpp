// The spring network's kernels for avx512 (see network_kernel.inl).
#define TROCAR_WIDTH 16
#define TROCAR_KERNELS kernels_avx512
#define TROCAR_KERNEL_NAME "avx512"
#if defined(__AVX512F__)
#include "network_kernel.inl"
#else
#include <trocar/tissue/network/network_layout.hpp>
namespace trocar::tissue {
const KernelSet* TROCAR_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
