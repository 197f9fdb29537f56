// The spring network's inner loop, one source for all SIMD widths. Included by network_kernel_<set>.cpp, which defines
// TROCAR_WIDTH (lanes) and TROCAR_KERNELS (the namespace and the function that hands the kernels out). Everything here
// lives in that file's own anonymous namespace, so that no other file can end up calling code of this instruction set.
//
// Rows of a slice sit in lanes. Each column brings one neighbour per lane: its 32 bytes are loaded whole and transposed
// in registers (gathering scalars costs ten times as much). Same operations in the same order for every width, exact
// square root and division, no fused multiply-add: same bits.

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

#include <trocar/tissue/network/network_layout.hpp>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // gcc 12's own _mm512_undefined_ps
#endif

namespace trocar::tissue {
namespace {

constexpr int W = TROCAR_WIDTH;
typedef float V __attribute__((vector_size(W * 4)));
typedef std::int32_t I __attribute__((vector_size(W * 4)));

struct Lanes {
  V x, y, z, vx, vy, vz;
};
/// A force, or a place.
struct Triple {
  V x, y, z;
};

#define TROCAR_INLINE static inline __attribute__((always_inline))

TROCAR_INLINE Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
TROCAR_INLINE Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
TROCAR_INLINE V all(float a) { return V{} + a; }
TROCAR_INLINE V load(const float* p) {
  V a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
/// Lanes as numbers.
struct Plain {
  std::int32_t lane[W];
};
TROCAR_INLINE Plain plain(I a) {
  Plain p;
  __builtin_memcpy(&p, &a, sizeof p);
  return p;
}
TROCAR_INLINE V magnitude(V a) { return (V)((I)a & 0x7fffffff); }
/// The sign of s on the magnitude a >= 0.
TROCAR_INLINE V with_sign(V a, V s) { return (V)((I)a | ((I)s & (I)(I{} + (std::int32_t)0x80000000u))); }
TROCAR_INLINE V where(I mask, V a) { return (V)(mask & (I)a); }
TROCAR_INLINE const float* node_at(const NodeState* nodes, std::uint32_t offset) {
  return reinterpret_cast<const float*>(reinterpret_cast<const char*>(nodes) + offset);
}

#if TROCAR_WIDTH == 16 && defined(__AVX512F__)

TROCAR_INLINE V smaller(V a, V b) { return (V)_mm512_min_ps((__m512)a, (__m512)b); }
TROCAR_INLINE V larger(V a, V b) { return (V)_mm512_max_ps((__m512)a, (__m512)b); }
TROCAR_INLINE V root(V a) { return (V)_mm512_sqrt_ps((__m512)a); }

TROCAR_INLINE __m512 node_pair(const NodeState* n, std::uint32_t a, std::uint32_t b) {
  return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(_mm256_load_ps(node_at(n, a)))),
                                             _mm256_castps_pd(_mm256_load_ps(node_at(n, b))), 1));
}
/// Four pairs of nodes (a b) -> per component the 128-bit lanes position of a, velocity of a, of b, of b.
TROCAR_INLINE void transpose4(__m512 p, __m512 q, __m512 r, __m512 s, __m512& x, __m512& y, __m512& z) {
  const __m512d pq = _mm512_castps_pd(_mm512_unpacklo_ps(p, q)), rs = _mm512_castps_pd(_mm512_unpacklo_ps(r, s));
  const __m512d pqz = _mm512_castps_pd(_mm512_unpackhi_ps(p, q)), rsz = _mm512_castps_pd(_mm512_unpackhi_ps(r, s));
  x = _mm512_castpd_ps(_mm512_unpacklo_pd(pq, rs));
  y = _mm512_castpd_ps(_mm512_unpackhi_pd(pq, rs));
  z = _mm512_castpd_ps(_mm512_unpacklo_pd(pqz, rsz));
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  __m512 xa, ya, za, xb, yb, zb;
  transpose4(node_pair(n, o[0], o[4]), node_pair(n, o[1], o[5]), node_pair(n, o[2], o[6]), node_pair(n, o[3], o[7]), xa,
             ya, za);
  transpose4(node_pair(n, o[8], o[12]), node_pair(n, o[9], o[13]), node_pair(n, o[10], o[14]),
             node_pair(n, o[11], o[15]), xb, yb, zb);
  return {(V)_mm512_shuffle_f32x4(xa, xb, 0x88), (V)_mm512_shuffle_f32x4(ya, yb, 0x88),
          (V)_mm512_shuffle_f32x4(za, zb, 0x88), (V)_mm512_shuffle_f32x4(xa, xb, 0xdd),
          (V)_mm512_shuffle_f32x4(ya, yb, 0xdd), (V)_mm512_shuffle_f32x4(za, zb, 0xdd)};
}

TROCAR_INLINE __m512 triple_quad(const char* f, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const auto at = [f](std::uint32_t o) { return _mm_load_ps(reinterpret_cast<const float*>(f + o)); };
  const __m256 ab = _mm256_insertf128_ps(_mm256_castps128_ps256(at(a)), at(b), 1);
  const __m256 cd = _mm256_insertf128_ps(_mm256_castps128_ps256(at(c)), at(d), 1);
  return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(ab)), _mm256_castps_pd(cd), 1));
}
TROCAR_INLINE Triple load_triples(const char* f, const std::uint32_t* o) {
  __m512 x, y, z;
  transpose4(triple_quad(f, o[0], o[4], o[8], o[12]), triple_quad(f, o[1], o[5], o[9], o[13]),
             triple_quad(f, o[2], o[6], o[10], o[14]), triple_quad(f, o[3], o[7], o[11], o[15]), x, y, z);
  return {(V)x, (V)y, (V)z};
}
TROCAR_INLINE void store_forces(float* p, const Triple& f) {
  const __m512 none = _mm512_setzero_ps();
  const auto lower = [](__m512 a, __m512 b) {
    return _mm512_castpd_ps(_mm512_unpacklo_pd(_mm512_castps_pd(a), _mm512_castps_pd(b)));
  };
  const auto upper = [](__m512 a, __m512 b) {
    return _mm512_castpd_ps(_mm512_unpackhi_pd(_mm512_castps_pd(a), _mm512_castps_pd(b)));
  };
  const __m512 xy = _mm512_unpacklo_ps((__m512)f.x, (__m512)f.y), XY = _mm512_unpackhi_ps((__m512)f.x, (__m512)f.y);
  const __m512 z0 = _mm512_unpacklo_ps((__m512)f.z, none), Z0 = _mm512_unpackhi_ps((__m512)f.z, none);
  _mm512_store_ps(p, lower(xy, z0));
  _mm512_store_ps(p + 16, upper(xy, z0));
  _mm512_store_ps(p + 32, lower(XY, Z0));
  _mm512_store_ps(p + 48, upper(XY, Z0));
}

#elif TROCAR_WIDTH == 8 && defined(__AVX__)

TROCAR_INLINE V smaller(V a, V b) { return (V)_mm256_min_ps((__m256)a, (__m256)b); }
TROCAR_INLINE V larger(V a, V b) { return (V)_mm256_max_ps((__m256)a, (__m256)b); }
TROCAR_INLINE V root(V a) { return (V)_mm256_sqrt_ps((__m256)a); }

/// Four nodes -> per component position in the low lane, velocity in the high lane.
TROCAR_INLINE void transpose4(__m256 p, __m256 q, __m256 r, __m256 s, __m256& x, __m256& y, __m256& z) {
  const __m256d pq = _mm256_castps_pd(_mm256_unpacklo_ps(p, q)), rs = _mm256_castps_pd(_mm256_unpacklo_ps(r, s));
  const __m256d pqz = _mm256_castps_pd(_mm256_unpackhi_ps(p, q)), rsz = _mm256_castps_pd(_mm256_unpackhi_ps(r, s));
  x = _mm256_castpd_ps(_mm256_unpacklo_pd(pq, rs));
  y = _mm256_castpd_ps(_mm256_unpackhi_pd(pq, rs));
  z = _mm256_castpd_ps(_mm256_unpacklo_pd(pqz, rsz));
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm256_load_ps(node_at(n, o[i])); };
  __m256 xa, ya, za, xb, yb, zb;
  transpose4(at(0), at(1), at(2), at(3), xa, ya, za);
  transpose4(at(4), at(5), at(6), at(7), xb, yb, zb);
  return {(V)_mm256_permute2f128_ps(xa, xb, 0x20), (V)_mm256_permute2f128_ps(ya, yb, 0x20),
          (V)_mm256_permute2f128_ps(za, zb, 0x20), (V)_mm256_permute2f128_ps(xa, xb, 0x31),
          (V)_mm256_permute2f128_ps(ya, yb, 0x31), (V)_mm256_permute2f128_ps(za, zb, 0x31)};
}

TROCAR_INLINE Triple load_triples(const char* f, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm_load_ps(reinterpret_cast<const float*>(f + o[i])); };
  const auto two = [&](int i) { return _mm256_insertf128_ps(_mm256_castps128_ps256(at(i)), at(i + 4), 1); };
  __m256 x, y, z;
  transpose4(two(0), two(1), two(2), two(3), x, y, z);
  return {(V)x, (V)y, (V)z};
}
TROCAR_INLINE void store_forces(float* p, const Triple& f) {
  const __m256 none = _mm256_setzero_ps();
  const auto lower = [](__m256 a, __m256 b) {
    return _mm256_castpd_ps(_mm256_unpacklo_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
  };
  const auto upper = [](__m256 a, __m256 b) {
    return _mm256_castpd_ps(_mm256_unpackhi_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
  };
  const __m256 xy = _mm256_unpacklo_ps((__m256)f.x, (__m256)f.y), XY = _mm256_unpackhi_ps((__m256)f.x, (__m256)f.y);
  const __m256 z0 = _mm256_unpacklo_ps((__m256)f.z, none), Z0 = _mm256_unpackhi_ps((__m256)f.z, none);
  _mm256_store_ps(p, lower(xy, z0));
  _mm256_store_ps(p + 16, upper(xy, z0));
  _mm256_store_ps(p + 32, lower(XY, Z0));
  _mm256_store_ps(p + 48, upper(XY, Z0));
}

#elif TROCAR_WIDTH == 4 && defined(__SSE2__) && !defined(TROCAR_PORTABLE)

TROCAR_INLINE V smaller(V a, V b) { return (V)_mm_min_ps((__m128)a, (__m128)b); }
TROCAR_INLINE V larger(V a, V b) { return (V)_mm_max_ps((__m128)a, (__m128)b); }
TROCAR_INLINE V root(V a) { return (V)_mm_sqrt_ps((__m128)a); }

TROCAR_INLINE void transpose4(__m128 p, __m128 q, __m128 r, __m128 s, V& x, V& y, V& z) {
  const __m128 pq = _mm_unpacklo_ps(p, q), rs = _mm_unpacklo_ps(r, s);
  const __m128 pqz = _mm_unpackhi_ps(p, q), rsz = _mm_unpackhi_ps(r, s);
  x = (V)_mm_movelh_ps(pq, rs);
  y = (V)_mm_movehl_ps(rs, pq);
  z = (V)_mm_movelh_ps(pqz, rsz);
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  const auto at = [&](int i, int half) { return _mm_load_ps(node_at(n, o[i]) + half); };
  Lanes a;
  transpose4(at(0, 0), at(1, 0), at(2, 0), at(3, 0), a.x, a.y, a.z);
  transpose4(at(0, 4), at(1, 4), at(2, 4), at(3, 4), a.vx, a.vy, a.vz);
  return a;
}

TROCAR_INLINE Triple load_triples(const char* f, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm_load_ps(reinterpret_cast<const float*>(f + o[i])); };
  Triple sum;
  transpose4(at(0), at(1), at(2), at(3), sum.x, sum.y, sum.z);
  return sum;
}
TROCAR_INLINE void store_forces(float* p, const Triple& f) {
  const __m128 none = _mm_setzero_ps();
  const __m128 xy = _mm_unpacklo_ps((__m128)f.x, (__m128)f.y), XY = _mm_unpackhi_ps((__m128)f.x, (__m128)f.y);
  const __m128 z0 = _mm_unpacklo_ps((__m128)f.z, none), Z0 = _mm_unpackhi_ps((__m128)f.z, none);
  _mm_store_ps(p, _mm_movelh_ps(xy, z0));
  _mm_store_ps(p + 16, _mm_movehl_ps(z0, xy));
  _mm_store_ps(p + 32, _mm_movelh_ps(XY, Z0));
  _mm_store_ps(p + 48, _mm_movehl_ps(Z0, XY));
}

#else  // any other machine: the compiler's own vectors

TROCAR_INLINE V pick(I mask, V a, V b) { return (V)((mask & (I)a) | (~mask & (I)b)); }
TROCAR_INLINE V smaller(V a, V b) { return pick((I)(a < b), a, b); }
TROCAR_INLINE V larger(V a, V b) { return pick((I)(a > b), a, b); }
TROCAR_INLINE V root(V a) {
  float lane[W];
  __builtin_memcpy(lane, &a, sizeof lane);
  for (int i = 0; i < W; ++i) lane[i] = __builtin_sqrtf(lane[i]);
  return load(lane);
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  float c[6][W];
  for (int i = 0; i < W; ++i) {
    const float* p = node_at(n, o[i]);
    for (int k = 0; k < 3; ++k) c[k][i] = p[k], c[3 + k][i] = p[4 + k];
  }
  return {load(c[0]), load(c[1]), load(c[2]), load(c[3]), load(c[4]), load(c[5])};
}
TROCAR_INLINE Triple load_triples(const char* f, const std::uint32_t* o) {
  float c[3][W];
  for (int i = 0; i < W; ++i)
    for (int k = 0; k < 3; ++k) __builtin_memcpy(&c[k][i], f + o[i] + 4 * k, 4);
  return {load(c[0]), load(c[1]), load(c[2])};
}
TROCAR_INLINE void store_forces(float* p, const Triple& f) {
  for (int i = 0; i < W; ++i) {
    float* const slot = p + 4 * kSlotOfLane[i];
    slot[0] = f.x[i], slot[1] = f.y[i], slot[2] = f.z[i], slot[3] = 0;
  }
}

#endif

TROCAR_INLINE Lanes load_rows(const NodeState* n, std::uint32_t row) {
  std::uint32_t offset[W];
  for (int i = 0; i < W; ++i) offset[i] = (row + std::uint32_t(i)) * std::uint32_t(sizeof(NodeState));
  return load_nodes(n, offset);
}

#if TROCAR_WIDTH == 4 && defined(__SSE2__) && !defined(TROCAR_PORTABLE)
TROCAR_INLINE void store_half(float* p, V x, V y, V z) {
  const __m128 zero = _mm_setzero_ps();
  const __m128 xy = _mm_unpacklo_ps((__m128)x, (__m128)y), XY = _mm_unpackhi_ps((__m128)x, (__m128)y);
  const __m128 z0 = _mm_unpacklo_ps((__m128)z, zero), Z0 = _mm_unpackhi_ps((__m128)z, zero);
  _mm_store_ps(p, _mm_movelh_ps(xy, z0));
  _mm_store_ps(p + 8, _mm_movehl_ps(z0, xy));
  _mm_store_ps(p + 16, _mm_movelh_ps(XY, Z0));
  _mm_store_ps(p + 24, _mm_movehl_ps(Z0, XY));
}
TROCAR_INLINE void store_rows(NodeState* n, const Lanes& a) {
  float* p = reinterpret_cast<float*>(n);
  store_half(p, a.x, a.y, a.z);
  store_half(p + 4, a.vx, a.vy, a.vz);
}
#elif TROCAR_WIDTH >= 8 && defined(__AVX__)
struct Quad {
  __m256 n0, n1, n2, n3;
};
/// Rows 0..3 in the low lanes and 4..7 in the high lanes of three components -> per row x y z 0.
TROCAR_INLINE Quad rows_of(__m256 x, __m256 y, __m256 z) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256d xy = _mm256_castps_pd(_mm256_unpacklo_ps(x, y)), XY = _mm256_castps_pd(_mm256_unpackhi_ps(x, y));
  const __m256d z0 = _mm256_castps_pd(_mm256_unpacklo_ps(z, zero)), Z0 = _mm256_castps_pd(_mm256_unpackhi_ps(z, zero));
  return {_mm256_castpd_ps(_mm256_unpacklo_pd(xy, z0)), _mm256_castpd_ps(_mm256_unpackhi_pd(xy, z0)),
          _mm256_castpd_ps(_mm256_unpacklo_pd(XY, Z0)), _mm256_castpd_ps(_mm256_unpackhi_pd(XY, Z0))};
}
TROCAR_INLINE void store8(float* p, __m256 x, __m256 y, __m256 z, __m256 vx, __m256 vy, __m256 vz) {
  const Quad a = rows_of(x, y, z), b = rows_of(vx, vy, vz);
  _mm256_store_ps(p, _mm256_permute2f128_ps(a.n0, b.n0, 0x20));
  _mm256_store_ps(p + 8, _mm256_permute2f128_ps(a.n1, b.n1, 0x20));
  _mm256_store_ps(p + 16, _mm256_permute2f128_ps(a.n2, b.n2, 0x20));
  _mm256_store_ps(p + 24, _mm256_permute2f128_ps(a.n3, b.n3, 0x20));
  _mm256_store_ps(p + 32, _mm256_permute2f128_ps(a.n0, b.n0, 0x31));
  _mm256_store_ps(p + 40, _mm256_permute2f128_ps(a.n1, b.n1, 0x31));
  _mm256_store_ps(p + 48, _mm256_permute2f128_ps(a.n2, b.n2, 0x31));
  _mm256_store_ps(p + 56, _mm256_permute2f128_ps(a.n3, b.n3, 0x31));
}
#if TROCAR_WIDTH == 16
TROCAR_INLINE __m256 half(V a, int which) {
  const __m512d d = _mm512_castps_pd((__m512)a);
  return _mm256_castpd_ps(which ? _mm512_extractf64x4_pd(d, 1) : _mm512_castpd512_pd256(d));
}
TROCAR_INLINE void store_rows(NodeState* n, const Lanes& a) {
  float* p = reinterpret_cast<float*>(n);
  for (int h = 0; h < 2; ++h)
    store8(p + 64 * h, half(a.x, h), half(a.y, h), half(a.z, h), half(a.vx, h), half(a.vy, h), half(a.vz, h));
}
#else
TROCAR_INLINE void store_rows(NodeState* n, const Lanes& a) {
  store8(reinterpret_cast<float*>(n), (__m256)a.x, (__m256)a.y, (__m256)a.z, (__m256)a.vx, (__m256)a.vy, (__m256)a.vz);
}
#endif
#else
TROCAR_INLINE void store_rows(NodeState* n, const Lanes& a) {
  float c[6][W];
  const V all_six[6] = {a.x, a.y, a.z, a.vx, a.vy, a.vz};
  __builtin_memcpy(c, all_six, sizeof c);
  for (int i = 0; i < W; ++i) n[i] = {c[0][i], c[1][i], c[2][i], 0, c[3][i], c[4][i], c[5][i], 0};
}
#endif

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
  I fine = ~I{};
  for (int s = first; s < last; ++s) {
    for (int part = 0; part < kSlice; part += W) {
      const Lanes own = load_rows(arg.in, std::uint32_t(s * kSlice + part));
      Triple sum{};
      for_columns<true, false>(arg, law, own, arg.slice_begin[s], arg.slice_begin[s + 1], part,
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
  static constexpr KernelSet set{TROCAR_KERNEL_NAME, run_substep, run_find_collapsed};
  return &set;
}

}  // namespace trocar::tissue
