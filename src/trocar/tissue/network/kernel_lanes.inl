// Registers of lanes for the kernels of one instruction set: what a lane can hold, how nodes come into lanes and go
// back. Included by network_kernel.inl; everything here lives in the anonymous namespace of the file that includes
// that, so that no other file can end up calling code of its instruction set.

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
/// What lies in 16 bytes.
struct Quads {
  Triple xyz;
  V w;
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
TROCAR_INLINE V pick(I mask, V a, V b) { return (V)((mask & (I)a) | (~mask & (I)b)); }
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
TROCAR_INLINE void transpose4(__m512 p, __m512 q, __m512 r, __m512 s, __m512& x, __m512& y, __m512& z, __m512& w) {
  const __m512d pq = _mm512_castps_pd(_mm512_unpacklo_ps(p, q)), rs = _mm512_castps_pd(_mm512_unpacklo_ps(r, s));
  const __m512d pqz = _mm512_castps_pd(_mm512_unpackhi_ps(p, q)), rsz = _mm512_castps_pd(_mm512_unpackhi_ps(r, s));
  x = _mm512_castpd_ps(_mm512_unpacklo_pd(pq, rs));
  y = _mm512_castpd_ps(_mm512_unpackhi_pd(pq, rs));
  z = _mm512_castpd_ps(_mm512_unpacklo_pd(pqz, rsz));
  w = _mm512_castpd_ps(_mm512_unpackhi_pd(pqz, rsz));
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  __m512 xa, ya, za, xb, yb, zb, unused;
  transpose4(node_pair(n, o[0], o[4]), node_pair(n, o[1], o[5]), node_pair(n, o[2], o[6]), node_pair(n, o[3], o[7]), xa,
             ya, za, unused);
  transpose4(node_pair(n, o[8], o[12]), node_pair(n, o[9], o[13]), node_pair(n, o[10], o[14]),
             node_pair(n, o[11], o[15]), xb, yb, zb, unused);
  return {(V)_mm512_shuffle_f32x4(xa, xb, 0x88), (V)_mm512_shuffle_f32x4(ya, yb, 0x88),
          (V)_mm512_shuffle_f32x4(za, zb, 0x88), (V)_mm512_shuffle_f32x4(xa, xb, 0xdd),
          (V)_mm512_shuffle_f32x4(ya, yb, 0xdd), (V)_mm512_shuffle_f32x4(za, zb, 0xdd)};
}

TROCAR_INLINE __m512 four_quads(const char* f, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const auto at = [f](std::uint32_t o) { return _mm_load_ps(reinterpret_cast<const float*>(f + o)); };
  const __m256 ab = _mm256_insertf128_ps(_mm256_castps128_ps256(at(a)), at(b), 1);
  const __m256 cd = _mm256_insertf128_ps(_mm256_castps128_ps256(at(c)), at(d), 1);
  return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(ab)), _mm256_castps_pd(cd), 1));
}
TROCAR_INLINE Quads load_quads(const char* f, const std::uint32_t* o) {
  __m512 x, y, z, w;
  transpose4(four_quads(f, o[0], o[4], o[8], o[12]), four_quads(f, o[1], o[5], o[9], o[13]),
             four_quads(f, o[2], o[6], o[10], o[14]), four_quads(f, o[3], o[7], o[11], o[15]), x, y, z, w);
  return {{(V)x, (V)y, (V)z}, (V)w};
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
TROCAR_INLINE void transpose4(__m256 p, __m256 q, __m256 r, __m256 s, __m256& x, __m256& y, __m256& z, __m256& w) {
  const __m256d pq = _mm256_castps_pd(_mm256_unpacklo_ps(p, q)), rs = _mm256_castps_pd(_mm256_unpacklo_ps(r, s));
  const __m256d pqz = _mm256_castps_pd(_mm256_unpackhi_ps(p, q)), rsz = _mm256_castps_pd(_mm256_unpackhi_ps(r, s));
  x = _mm256_castpd_ps(_mm256_unpacklo_pd(pq, rs));
  y = _mm256_castpd_ps(_mm256_unpackhi_pd(pq, rs));
  z = _mm256_castpd_ps(_mm256_unpacklo_pd(pqz, rsz));
  w = _mm256_castpd_ps(_mm256_unpackhi_pd(pqz, rsz));
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm256_load_ps(node_at(n, o[i])); };
  __m256 xa, ya, za, xb, yb, zb, unused;
  transpose4(at(0), at(1), at(2), at(3), xa, ya, za, unused);
  transpose4(at(4), at(5), at(6), at(7), xb, yb, zb, unused);
  return {(V)_mm256_permute2f128_ps(xa, xb, 0x20), (V)_mm256_permute2f128_ps(ya, yb, 0x20),
          (V)_mm256_permute2f128_ps(za, zb, 0x20), (V)_mm256_permute2f128_ps(xa, xb, 0x31),
          (V)_mm256_permute2f128_ps(ya, yb, 0x31), (V)_mm256_permute2f128_ps(za, zb, 0x31)};
}

TROCAR_INLINE Quads load_quads(const char* f, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm_load_ps(reinterpret_cast<const float*>(f + o[i])); };
  const auto two = [&](int i) { return _mm256_insertf128_ps(_mm256_castps128_ps256(at(i)), at(i + 4), 1); };
  __m256 x, y, z, w;
  transpose4(two(0), two(1), two(2), two(3), x, y, z, w);
  return {{(V)x, (V)y, (V)z}, (V)w};
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

TROCAR_INLINE void transpose4(__m128 p, __m128 q, __m128 r, __m128 s, V& x, V& y, V& z, V& w) {
  const __m128 pq = _mm_unpacklo_ps(p, q), rs = _mm_unpacklo_ps(r, s);
  const __m128 pqz = _mm_unpackhi_ps(p, q), rsz = _mm_unpackhi_ps(r, s);
  x = (V)_mm_movelh_ps(pq, rs);
  y = (V)_mm_movehl_ps(rs, pq);
  z = (V)_mm_movelh_ps(pqz, rsz);
  w = (V)_mm_movehl_ps(rsz, pqz);
}
TROCAR_INLINE Lanes load_nodes(const NodeState* n, const std::uint32_t* o) {
  const auto at = [&](int i, int half) { return _mm_load_ps(node_at(n, o[i]) + half); };
  Lanes a;
  V unused;
  transpose4(at(0, 0), at(1, 0), at(2, 0), at(3, 0), a.x, a.y, a.z, unused);
  transpose4(at(0, 4), at(1, 4), at(2, 4), at(3, 4), a.vx, a.vy, a.vz, unused);
  return a;
}

TROCAR_INLINE Quads load_quads(const char* f, const std::uint32_t* o) {
  const auto at = [&](int i) { return _mm_load_ps(reinterpret_cast<const float*>(f + o[i])); };
  Quads a;
  transpose4(at(0), at(1), at(2), at(3), a.xyz.x, a.xyz.y, a.xyz.z, a.w);
  return a;
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
TROCAR_INLINE Quads load_quads(const char* f, const std::uint32_t* o) {
  float c[4][W];
  for (int i = 0; i < W; ++i)
    for (int k = 0; k < 4; ++k) __builtin_memcpy(&c[k][i], f + o[i] + 4 * k, 4);
  return {{load(c[0]), load(c[1]), load(c[2])}, load(c[3])};
}
TROCAR_INLINE void store_forces(float* p, const Triple& f) {
  for (int i = 0; i < W; ++i) {
    float* const slot = p + 4 * kSlotOfLane[i];
    slot[0] = f.x[i], slot[1] = f.y[i], slot[2] = f.z[i], slot[3] = 0;
  }
}

#endif

TROCAR_INLINE Triple load_triples(const char* f, const std::uint32_t* o) { return load_quads(f, o).xyz; }

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
struct FourRows {
  __m256 n0, n1, n2, n3;
};
/// Rows 0..3 in the low lanes and 4..7 in the high lanes of three components -> per row x y z 0.
TROCAR_INLINE FourRows rows_of(__m256 x, __m256 y, __m256 z) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256d xy = _mm256_castps_pd(_mm256_unpacklo_ps(x, y)), XY = _mm256_castps_pd(_mm256_unpackhi_ps(x, y));
  const __m256d z0 = _mm256_castps_pd(_mm256_unpacklo_ps(z, zero)), Z0 = _mm256_castps_pd(_mm256_unpackhi_ps(z, zero));
  return {_mm256_castpd_ps(_mm256_unpacklo_pd(xy, z0)), _mm256_castpd_ps(_mm256_unpackhi_pd(xy, z0)),
          _mm256_castpd_ps(_mm256_unpacklo_pd(XY, Z0)), _mm256_castpd_ps(_mm256_unpackhi_pd(XY, Z0))};
}
TROCAR_INLINE void store8(float* p, __m256 x, __m256 y, __m256 z, __m256 vx, __m256 vy, __m256 vz) {
  const FourRows a = rows_of(x, y, z), b = rows_of(vx, vy, vz);
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

}  // namespace
}  // namespace trocar::tissue
