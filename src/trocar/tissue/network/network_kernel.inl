// The spring network's inner loop, one source for all SIMD widths. Included by network_kernel_<set>.cpp, which defines
// TROCAR_WIDTH (lanes) and TROCAR_KERNELS (the namespace and the function that hands the kernels out). Everything here
// lives in that file's own anonymous namespace, so that no other file can end up calling code of this instruction set.
//
// Rows of a slice sit in lanes. Each column brings one neighbour per lane: its 32 bytes are loaded whole and transposed
// in registers (gathering scalars costs ten times as much). Same operations in the same order for every width, exact
// square root and division, no fused multiply-add: same bits.

#include "kernel_lanes.inl"
#include "volume_kernel.inl"

namespace trocar::tissue {
namespace {

struct Law {
  V p1, p2, cap, cap_slope;
};

/// From one end of a spring to the other, and how that changes.
struct Reach {
  V dx, dy, dz, r, inv_r, towards;  ///< towards: dv . d, the rate at which r grows times r
};
TROCAR_INLINE Reach reach_of(const KernelArgs& arg, const Lanes& own, int c, int part) {
  const Lanes far = load_nodes(arg.in, arg.packs[c].offset + part);
  Reach a;
  a.dx = far.x - own.x, a.dy = far.y - own.y, a.dz = far.z - own.z;
  a.r = root(larger((a.dx * a.dx + a.dy * a.dy) + a.dz * a.dz, all(1e-24f)));
  a.inv_r = 1.0f / a.r;
  a.towards = ((far.vx - own.vx) * a.dx + (far.vy - own.vy) * a.dy) + (far.vz - own.vz) * a.dz;
  return a;
}

/// Force along r per length of r [N/m]: the polynomial spring [KCM99 eq.5] in [KCM99 eq.2], and its damper.
TROCAR_INLINE V force_per_length(const Reach& a, V inv_rest, V stiffness, V damping, const Law& law) {
  const V inv_r = smaller(a.inv_r, 2.0f * inv_rest);  // below half its length a spring pushes less: network.hpp
  const V strain = a.r * inv_rest - 1.0f;
  const V size = magnitude(strain);
  const V capped = smaller(size, law.cap);
  const V shape = (capped + capped * capped * (law.p1 + law.p2 * capped)) + law.cap_slope * (size - capped);
  return (stiffness * with_sign(shape, strain) + damping * (a.towards * inv_r)) * inv_r;
}

/// Zero below about 1e-22, so that a body at rest does not sink into denormal numbers.
TROCAR_INLINE V flushed(V a) { return (a + 1e-15f) - 1e-15f; }

/// What column c of springs does to the rows at their near ends.
template <bool OneLaw, bool Scaled>
TROCAR_INLINE Triple pull(const KernelArgs& arg, const Law& one, const Reach& a, int c, int part) {
  const HalfEdgePack& e = arg.packs[c];
  Law law = one;
  if constexpr (!OneLaw) {
    const LawPack& l = arg.laws[c];
    law = {load(l.p1 + part), load(l.p2 + part), load(l.cap + part), load(l.cap_slope + part)};
  }
  V q = force_per_length(a, load(e.inv_rest + part), load(e.stiffness + part), load(e.damping + part), law);
  if constexpr (Scaled) q = q * load(arg.scale + c * kSlice + part);
  return {q * a.dx, q * a.dy, q * a.dz};
}

/// Hands the forces of columns [first, last) to put(force), in order. The next column's roots are on their way while
/// this one's law is worked out, so that neither waits for the other.
template <bool OneLaw, bool Scaled, class Put>
TROCAR_INLINE void for_columns(const KernelArgs& arg, const Law& one, const Lanes& own, int first, int last, int part,
                               Put&& put) {
  if (first == last) return;
  Reach now = reach_of(arg, own, first, part);
  for (int c = first; c + 1 < last; ++c) {
    const Reach next = reach_of(arg, own, c + 1, part);
    put(pull<OneLaw, Scaled>(arg, one, now, c, part));
    now = next;
  }
  put(pull<OneLaw, Scaled>(arg, one, now, last - 1, part));
}

/// v += dt B h / m with gamma at the new v, then x += dt v [KCM99 eq.3]. Lanes whose result is beyond 1e6, or no
/// number, lose their bits in `fine`.
TROCAR_INLINE void move_rows(const KernelArgs& arg, const Lanes& own, const Triple& f, int s, int part, I& fine) {
  const RowPack& row = arg.rows[s];
  const V wx = load(row.wx + part), wy = load(row.wy + part), wz = load(row.wz + part), none{};
  Lanes next;
  next.vx = flushed(arg.decay * own.vx + (wx * f.x + where((I)(wx > none), all(arg.gravity_step[0]))));
  next.vy = flushed(arg.decay * own.vy + (wy * f.y + where((I)(wy > none), all(arg.gravity_step[1]))));
  next.vz = flushed(arg.decay * own.vz + (wz * f.z + where((I)(wz > none), all(arg.gravity_step[2]))));
  next.x = own.x + arg.dt * next.vx;
  next.y = own.y + arg.dt * next.vy;
  next.z = own.z + arg.dt * next.vz;
  const V size = ((magnitude(next.x) + magnitude(next.y)) + magnitude(next.z)) +
                 ((magnitude(next.vx) + magnitude(next.vy)) + magnitude(next.vz));
  fine &= (I)(size < all(1e6f));
  store_rows(arg.out + s * kSlice + part, next);
}

TROCAR_INLINE bool all_lanes(I fine) {
  const Plain lanes = plain(fine);
  std::int32_t ok = -1;
  for (int i = 0; i < W; ++i) ok &= lanes.lane[i];
  return ok != 0;
}

/// Every spring from both its ends.
bool substep_twice(const KernelArgs& arg, int first, int last) {
  const Law law{all(arg.p1), all(arg.p2), all(arg.cap), all(arg.cap_slope)};
  const int* const ends = arg.slice_end ? arg.slice_end : arg.slice_begin + 1;
  I fine = ~I{};
  for (int s = first; s < last; ++s) {
    for (int part = 0; part < kSlice; part += W) {
      const Lanes own = load_rows(arg.in, std::uint32_t(s * kSlice + part));
      Triple sum{};
      for_columns<true, false>(arg, law, own, arg.slice_begin[s], ends[s], part,
                               [&](const Triple& f) { sum = sum + f; });
      move_rows(arg, own, sum, s, part, fine);
    }
  }
  return all_lanes(fine);
}

/// The springs that the rows of a slice evaluate: their sum stays with the slice, each one's force is put down for its
/// other end.
template <bool OneLaw, bool Scaled>
TROCAR_INLINE void evaluate(const KernelArgs& arg, const Law& one, int s) {
  const int first = arg.slice_begin[s], last = arg.slice_begin[s + 1], start = first % arg.ring;
  ForceSum& total = arg.sums[s % (arg.lag + 1)];
  for (int part = 0; part < kSlice; part += W) {
    const Lanes own = load_rows(arg.in, std::uint32_t(s * kSlice + part));
    Triple sum{};
    int at = start;
    for_columns<OneLaw, Scaled>(arg, one, own, first, last, part, [&](const Triple& f) {
      sum = sum + f;
      store_forces(arg.forces[1 + at].slot[kSlotOfLane[part]], f);
      at = at + 1 == arg.ring ? 0 : at + 1;
    });
    __builtin_memcpy(total.x + part, &sum.x, sizeof sum.x);
    __builtin_memcpy(total.y + part, &sum.y, sizeof sum.y);
    __builtin_memcpy(total.z + part, &sum.z, sizeof sum.z);
  }
}

/// The forces of the springs whose other ends have evaluated them; then the rows move.
TROCAR_INLINE void finish(const KernelArgs& arg, int s, I& fine) {
  const ForceSum& total = arg.sums[s % (arg.lag + 1)];
  const char* const forces = reinterpret_cast<const char*>(arg.forces);
  for (int part = 0; part < kSlice; part += W) {
    Triple sum{load(total.x + part), load(total.y + part), load(total.z + part)};
    for (int c = arg.arrival_begin[s]; c < arg.arrival_begin[s + 1]; ++c) {
      sum = sum - load_triples(forces, arg.arrivals[c].offset + part);
    }
    move_rows(arg, load_rows(arg.in, std::uint32_t(s * kSlice + part)), sum, s, part, fine);
  }
}

/// Every spring once. A slice is finished when all slices that have springs into it are evaluated; a part of the body
/// evaluates those at its fringes for itself, so that parts need not wait for each other.
template <bool OneLaw, bool Scaled>
bool substep_once(const KernelArgs& arg, int first, int last) {
  const Law one{all(arg.p1), all(arg.p2), all(arg.cap), all(arg.cap_slope)};
  I fine = ~I{};
  arg.forces[0] = ForcePack{};
  int evaluated = first > arg.lag ? first - arg.lag : 0;
  for (int s = first; s < last; ++s) {
    for (; evaluated <= s + arg.lag && evaluated < arg.slices; ++evaluated)
      evaluate<OneLaw, Scaled>(arg, one, evaluated);
    finish(arg, s, fine);
  }
  return all_lanes(fine);
}

bool run_substep(const KernelArgs& arg, int first, int last) noexcept {
  if (!arg.arrivals) return substep_twice(arg, first, last);
  if (arg.laws)
    return arg.scale ? substep_once<false, true>(arg, first, last) : substep_once<false, false>(arg, first, last);
  return arg.scale ? substep_once<true, true>(arg, first, last) : substep_once<true, false>(arg, first, last);
}

void run_find_collapsed(const NodeState* nodes, const TetPack* packs, int first, int last,
                        std::uint16_t* below) noexcept {
  const char* const places = reinterpret_cast<const char*>(nodes);
  for (int p = first; p < last; ++p) {
    std::uint32_t bits = 0;
    for (int part = 0; part < kSlice; part += W) {
      const Triple o = load_triples(places, packs[p].offset[0] + part);
      const Triple a = load_triples(places, packs[p].offset[1] + part);
      const Triple b = load_triples(places, packs[p].offset[2] + part);
      const Triple c = load_triples(places, packs[p].offset[3] + part);
      const V ax = a.x - o.x, ay = a.y - o.y, az = a.z - o.z;
      const V bx = b.x - o.x, by = b.y - o.y, bz = b.z - o.z;
      const V cx = c.x - o.x, cy = c.y - o.y, cz = c.z - o.z;
      const V six = (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz)) + az * (bx * cy - by * cx);
      const I mask = (I)(six < load(packs[p].limit6 + part));
      const Plain lanes = plain(mask);
      for (int i = 0; i < W; ++i) bits |= (std::uint32_t(lanes.lane[i]) & 1u) << (part + i);
    }
    below[p - first] = std::uint16_t(bits);
  }
}

}  // namespace

const KernelSet* TROCAR_KERNELS() noexcept {
  static constexpr KernelSet set{TROCAR_KERNEL_NAME, run_substep, run_find_collapsed, run_press};
  return &set;
}

}  // namespace trocar::tissue
