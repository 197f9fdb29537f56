// The pool's loops for any processor (see pool_kernel.inl).
#define TROCAR_POOL_KERNELS pool_kernels_plain
#define TROCAR_POOL_NAME "plain"
#include "pool_kernel.inl"
