// The arrays of the spring network as its kernels read them: plain structs, nothing from the standard library but
// integer names, so that files compiled for other instruction sets share no inline code with the rest.
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>

namespace trocar::tissue {

inline constexpr int kSlice = 16;  ///< rows per slice; every SIMD width divides it

/// A node: position relative to the model's origin [m], velocity [m/s]. 32 bytes, loaded whole.
struct alignas(32) NodeState {
  float x = 0, y = 0, z = 0, zero0 = 0;
  float vx = 0, vy = 0, vz = 0, zero1 = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("y", s.y), v("z", s.z), v("zero0", s.zero0), v("vx", s.vx), v("vy", s.vy), v("vz", s.vz),
        v("zero1", s.zero1);
  }
};

/// 16 springs, each seen from one of its ends: one column of a slice. Padding has k l = 0 and points at its own row.
struct alignas(64) HalfEdgePack {
  std::uint32_t offset[kSlice];  ///< byte offset of the other node in the node array
  float inv_rest[kSlice];        ///< 1/l [1/m]
  float stiffness[kSlice];       ///< k l [N]
  float damping[kSlice];         ///< [N s/m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("offset", s.offset), v("inv_rest", s.inv_rest), v("stiffness", s.stiffness), v("damping", s.damping);
  }
};

/// Forces of 16 springs as the kernel leaves them for their other ends [N]; lane i lies in kSlotOfLane[i].
struct alignas(64) ForcePack {
  float slot[kSlice][4];  ///< x, y, z, 0
};
/// Lanes a quarter apart lie side by side: that is how registers of every width can store them whole.
constexpr int kSlotOfLane[kSlice] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};

/// Where 16 rows find the force of a spring that its other end has evaluated. Padding points at 0, where no force is.
struct alignas(64) ArrivalPack {
  std::uint32_t offset[kSlice];  ///< byte offset in KernelArgs::forces

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("offset", s.offset);
  }
};

/// Sum of the forces of the springs that 16 rows evaluate themselves [N].
struct alignas(64) ForceSum {
  float x[kSlice], y[kSlice], z[kSlice];
};

/// Shape factors per spring, only where springs of a body differ.
struct alignas(64) LawPack {
  float p1[kSlice], p2[kSlice], cap[kSlice], cap_slope[kSlice];

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("p1", s.p1), v("p2", s.p2), v("cap", s.cap), v("cap_slope", s.cap_slope);
  }
};

/// dt B / (m (1 + dt gamma)) per axis, for 16 rows.
struct alignas(64) RowPack {
  float wx[kSlice], wy[kSlice], wz[kSlice];

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("wx", s.wx), v("wy", s.wy), v("wz", s.wz);
  }
};

/// 16 protected cells: their corners, and the six-fold volume below which they are pushed open.
struct alignas(64) TetPack {
  std::uint32_t offset[4][kSlice];  ///< byte offsets of the corners
  float limit6[kSlice];             ///< [m^3]; padding: -infinity

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("corner0", s.offset[0]), v("corner1", s.offset[1]), v("corner2", s.offset[2]), v("corner3", s.offset[3]),
        v("limit6", s.limit6);
  }
};

/// Four floats that are loaded whole.
struct alignas(16) Quad {
  float x = 0, y = 0, z = 0, w = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("y", s.y), v("z", s.z), v("w", s.w);
  }
};

/// Corners of 16 cells.
struct alignas(64) CornerPack {
  std::uint32_t offset[4][kSlice];  ///< byte offsets in an array of Quads, by row

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("corner0", s.offset[0]), v("corner1", s.offset[1]), v("corner2", s.offset[2]), v("corner3", s.offset[3]);
  }
};

/// A cell at each of 16 rows: where it has left its answer and what it does to that corner. Padding points at 0, where
/// nothing is.
struct alignas(64) CellPack {
  std::uint32_t answer[kSlice];  ///< byte offset in VolumeArgs::answers
  std::uint32_t force[kSlice];   ///< byte offset in VolumeArgs::forces

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("answer", s.answer), v("force", s.force);
  }
};

/// What 16 cells keep from the first look at them to the push.
struct alignas(64) CellBounds {
  float share[kSlice];  ///< of its pressure that a cell has, by how far it is from its drawn volume
  float speed[kSlice];  ///< of its liveliest corner, for a unit of pressure [m/s/Pa]
};

/// A cell's phase counts, while it is pushed open, the ticks for which it has been at rest or without hands.
inline constexpr std::uint8_t kOldestFold = 200, kGone = 255;

/// What one impulse of the volume force reads and writes (volume_force.hpp). Cells sit in lanes. What a cell does to
/// its corners it puts down, 16 cells in the order of kSlotOfLane, and each row picks up what its cells have left, in
/// their order: no scatter.
struct VolumeArgs {
  const CornerPack* corners = nullptr;
  const float* rest6 = nullptr;         ///< in the drawn shape [m^3]
  const std::uint8_t* phase = nullptr;  ///< (cells) kGone: counts as it was drawn; null: none is gone
  const int* cell = nullptr;            ///< (whole packs) whose phase that is; -1: none
  const CellPack* around = nullptr;
  const int* around_begin = nullptr;  ///< (slices + 1) first pack of each slice
  const int* last_pack = nullptr;     ///< (slices) of corners that a slice's rows need
  const int* last_slice = nullptr;    ///< (packs) of rows that a pack's cells need
  const Quad* weight = nullptr;       ///< (rows) as RowPack; w: 1/m
  const float* drawn = nullptr;       ///< (rows) volume of the node [m^3]
  const float* kappa = nullptr;       ///< (rows) 0: it does not press [Pa]
  float most_answer = 0;              ///< beyond it a node presses less; 0: whatever it is
  float dt = 0;                       ///< for which the impulse stands [s]
  float times = 0;                    ///< dt over that of the weights
  int packs = 0, slices = 0;

  NodeState* nodes = nullptr;
  float* node_answer = nullptr;  ///< (rows) out: sum |dV/dx|^2 / m over the node's volume in the drawn shape
  Quad* places = nullptr;        ///< (rows) scratch
  ForcePack* answers = nullptr;  ///< (1 + packs) scratch: nothing, then what the cells of a pack say
  ForcePack* forces = nullptr;   ///< (1 + 4 packs) scratch: nothing, then what they do, a corner after the other
  CellBounds* bounds = nullptr;  ///< (packs) scratch
};

/// What one sub-step reads and writes.
struct KernelArgs {
  const NodeState* in = nullptr;
  NodeState* out = nullptr;
  const HalfEdgePack* packs = nullptr;
  const LawPack* laws = nullptr;  ///< null: one law, below
  const float* scale = nullptr;   ///< null: all whole
  const RowPack* rows = nullptr;
  const int* slice_begin = nullptr;
  const int* slice_end = nullptr;  ///< null: where the next one begins
  float p1 = 0, p2 = 0, cap = 1, cap_slope = 1;
  float decay = 1;
  float gravity_step[3] = {0, 0, 0};
  float dt = 0;

  /// Springs that are evaluated once: in their source's slice, at most `lag` slices before or after that of their other
  /// end, which picks their force up. Null: `packs` has every spring twice, once for each end.
  const ArrivalPack* arrivals = nullptr;
  const int* arrival_begin = nullptr;  ///< (slices + 1) first pack of each slice
  ForcePack* forces = nullptr;         ///< (1 + ring) scratch: nothing, then column c at 1 + c % ring
  ForceSum* sums = nullptr;            ///< (lag + 1) scratch: slice s at s % (lag + 1)
  int slices = 0, lag = 0, ring = 1;
};

/// Kernels of one instruction set.
struct KernelSet {
  const char* name = "";
  /// One sub-step of slices [first, last). False where a result is not finite or beyond 1e6.
  bool (*substep)(const KernelArgs&, int first, int last) noexcept = nullptr;
  /// below[i] = bit mask of the cells of pack first + i whose six-fold volume is under their limit.
  void (*find_collapsed)(const NodeState* nodes, const TetPack* packs, int first, int last,
                         std::uint16_t* below) noexcept = nullptr;
  /// One impulse of the volume force.
  void (*press)(const VolumeArgs&) noexcept = nullptr;
};

/// Null where not compiled for this target.
const KernelSet* kernels_generic() noexcept;
const KernelSet* kernels_sse2() noexcept;
const KernelSet* kernels_avx2() noexcept;
const KernelSet* kernels_avx512() noexcept;

}  // namespace trocar::tissue
