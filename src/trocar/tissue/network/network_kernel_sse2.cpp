// The spring network's kernels for sse2 (see network_kernel.inl).
#define TROCAR_WIDTH 4
#define TROCAR_KERNELS kernels_sse2
#define TROCAR_KERNEL_NAME "sse2"
#if defined(__SSE2__)
#include "network_kernel.inl"
#else
#include <trocar/tissue/network/network_layout.hpp>
namespace trocar::tissue {
const KernelSet* TROCAR_KERNELS() noexcept { return nullptr; }
}  // namespace trocar::tissue
#endif
