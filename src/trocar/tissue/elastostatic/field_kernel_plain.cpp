// The elastostatic solver's loops for every machine (see field_kernel.inl).
#define TROCAR_FIELD_KERNELS field_kernels_plain
#define TROCAR_FIELD_NAME "plain"
#include "field_kernel.inl"
