// The pool's loops along rows of cells and faces, compiled once per instruction set and chosen at run time. Each lane
// is a cell or a face on its own, so every width gives the same bits.
//
// In the arrays, face k lies between the cells k - step and k, step being 1 for faces across u and the stride for faces
// across v; walls are faces (and the spare cell at the end of each row) that stay 0. Loops go from k0 to k1.
#pragma once

#include <cstddef>
#include <cstdint>

namespace trocar::fluids {

inline constexpr int kPoolLanes = 16;  ///< rows of faces across u that are solved at once

struct PoolConstants {
  float g, dt, per_dx, third, inertia_depth;
  float friction, viscous, damping, fastest;
};

struct PoolFaces {
  const float *bed, *depth, *eta, *speed, *across;
  std::ptrdiff_t step, side;
  const float* beside;  ///< speeds of faces k - side stand at k - side in it: `speed`, unless those have moved on
};

/// Three species of a row of cells, and what they amount to.
struct PoolRow {
  const std::int32_t *blood, *saline, *bile;
  const float* bed;
  float *volume, *depth, *eta;
};

/// Sixteen rows of faces across u, each an array of nx; the system of eliminate() is solved along each.
struct PoolStrip {
  const float *under[kPoolLanes], *mass[kPoolLanes], *rhs[kPoolLanes];
  float* answer[kPoolLanes];
  float *turned_under, *turned_mass, *turned_rhs, *sweep;  ///< scratch (16 nx)
};

struct PoolKernels {
  const char* name;
  std::int32_t (*lay_bed)(int n, const float* floor, float* bed);
  void (*describe)(int n, float height_per_pl, const PoolRow& row, std::int32_t* any);  ///< any: 3, of each species
  void (*raise_tops)(int n, const float* z, float bound, float* tops);
  void (*raise_sizes)(int n, const float* z, float* tops);
  void (*look_at_faces)(const PoolFaces& a, int k0, int k1, float* under, float* flux);
  void (*look_at_columns)(const PoolFaces& a, int k0, int k1, const PoolConstants& c, float* inertia, float* extra);
  void (*push_faces)(const PoolFaces& a, int k0, int k1, const PoolConstants& c, const float* under, const float* flux,
                     const float* extra, float* rhs, float* carried);
  void (*eliminate)(int n, const float* under, const float* mass_before, const float* mass, const float* rhs,
                    const float* sweep_before, const float* answer_before, float* sweep, float* answer);
  void (*substitute)(int n, const float* sweep, const float* answer_after, float* answer);
  void (*solve_strip)(int nx, const PoolStrip& s);
  void (*slow_faces)(int k0, int k1, const PoolConstants& c, const float* under, const float* carried,
                     const float* answer, float* speed);
  void (*volumes_through)(const PoolFaces& a, int k0, int k1, const PoolConstants& c, float pl_per_flux, float* speed,
                          float* flux);  ///< a.speed is `speed`
  void (*find_shares)(int k0, int k1, int stride, const float* flux_u, const float* flux_v, const float* volume,
                      const std::int32_t* species, float* keep);
  void (*find_moved)(int k0, int k1, std::ptrdiff_t step, float most_in_a_cell, const float* flux, const float* volume,
                     const float* keep, std::int32_t* moved);
  void (*book)(int k0, int k1, int stride, const std::int32_t* moved_u, const std::int32_t* moved_v,
               std::int32_t* species);
};

const PoolKernels* pool_kernels_plain() noexcept;
const PoolKernels* pool_kernels_avx2() noexcept;    ///< null where it was not compiled
const PoolKernels* pool_kernels_avx512() noexcept;  ///< the same

/// The widest that this machine runs, or what the environment variable TROCAR_SIMD names (avx512, avx2, others: plain).
const PoolKernels& pool_kernels() noexcept;
/// For tests. @return false if this machine cannot
bool use_pool_kernels(const PoolKernels* kernels) noexcept;

}  // namespace trocar::fluids
