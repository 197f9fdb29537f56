// The spring network's kernels for generic (see network_kernel.inl).
#define TROCAR_WIDTH 4
#define TROCAR_KERNELS kernels_generic
#define TROCAR_KERNEL_NAME "generic"
#define TROCAR_PORTABLE
#include "network_kernel.inl"
