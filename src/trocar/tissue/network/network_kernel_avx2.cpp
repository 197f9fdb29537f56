// The spring network's kernels for avx2 (see network_kernel.inl).
#define TROCAR_WIDTH 8
#define TROCAR_KERNELS kernels_avx2
#define TROCAR_KERNEL_NAME "avx2"
#if defined(__AVX2__)
#include "network_kernel.inl"
#else
#include <trocar/tissue/network/network_layout.hpp>
namespace trocar::tissue {
const KernelSet* TROCAR_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
