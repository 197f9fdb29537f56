// Dense elimination's loops for any processor (see dense_kernel.inl).
#define TROCAR_DENSE_KERNELS dense_kernels_plain
#define TROCAR_DENSE_NAME "plain"
#define TROCAR_DENSE_LANE 2
#define TROCAR_DENSE_LANES 2
#define TROCAR_DENSE_COLUMNS 4
#include "dense_kernel.inl"
