// The caster's lanes in AVX2: gathers of two neighbouring voxels at once.
#include <trocar/volumes/show/caster_kernel.hpp>

#ifdef __AVX2__

#include <cstddef>

#include <immintrin.h>

namespace trocar::volumes {
namespace {
namespace avx2 {

struct F {
  __m256 v;
};
struct I {
  __m256i v;
};
struct M {
  __m256 v;
};

inline F all(float x) { return {_mm256_set1_ps(x)}; }
inline I all(int x) { return {_mm256_set1_epi32(x)}; }
inline F operator+(F a, F b) { return {_mm256_add_ps(a.v, b.v)}; }
inline F operator-(F a, F b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline F operator*(F a, F b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline F operator/(F a, F b) { return {_mm256_div_ps(a.v, b.v)}; }
inline I operator+(I a, I b) { return {_mm256_add_epi32(a.v, b.v)}; }
inline I operator-(I a, I b) { return {_mm256_sub_epi32(a.v, b.v)}; }
inline I operator*(I a, I b) { return {_mm256_mullo_epi32(a.v, b.v)}; }
inline F lesser_of(F a, F b) { return {_mm256_min_ps(a.v, b.v)}; }
inline F greater_of(F a, F b) { return {_mm256_max_ps(a.v, b.v)}; }
inline I lesser_of(I a, I b) { return {_mm256_min_epi32(a.v, b.v)}; }
inline F absolute(F a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
inline F root(F a) { return {_mm256_sqrt_ps(a.v)}; }
inline I whole(F a) { return {_mm256_cvttps_epi32(a.v)}; }
inline F real(I a) { return {_mm256_cvtepi32_ps(a.v)}; }
inline I bits_of(I a, int shift, int mask) {
  return {_mm256_and_si256(_mm256_srli_epi32(a.v, shift), _mm256_set1_epi32(mask))};
}
inline M less(F a, F b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)}; }
inline M is_zero(I a) { return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(a.v, _mm256_setzero_si256()))}; }
inline M both(M a, M b) { return {_mm256_and_ps(a.v, b.v)}; }
inline bool any(M m) { return _mm256_movemask_ps(m.v) != 0; }
inline F pick(M m, F a, F b) { return {_mm256_blendv_ps(b.v, a.v, m.v)}; }
inline void pair_at(const std::int16_t* from, I at, F& low, F& high) {
  const __m256i two = _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), at.v, 2);
  low = {_mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(two, 16), 16))};
  high = {_mm256_cvtepi32_ps(_mm256_srai_epi32(two, 16))};
}
inline F entry_of(const float* from, I at) { return {_mm256_i32gather_ps(from, at.v, 4)}; }
/// Three bytes behind the last one are read, too.
inline I byte_at(const std::uint8_t* from, I at) {
  return {
      _mm256_and_si256(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), at.v, 1), _mm256_set1_epi32(255))};
}
inline I cell_of(F at, int cells) {
  const __m256 inside = _mm256_min_ps(_mm256_max_ps(at.v, _mm256_setzero_ps()), _mm256_set1_ps(1e6f));
  return {_mm256_min_epi32(_mm256_srli_epi32(_mm256_cvttps_epi32(inside), 3), _mm256_set1_epi32(cells - 1))};
}
inline I lane_x() { return {_mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3)}; }
inline I lane_y() { return {_mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1)}; }
inline void store(std::int32_t* to, I a) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a.v); }
inline void store(float* to, F a) { _mm256_storeu_ps(to, a.v); }

#include "caster_kernel.inl"

}  // namespace avx2
}  // namespace

const CasterKernel* caster_avx2() noexcept {
  static const CasterKernel kernel{"avx2", avx2::cast_tile};
  return &kernel;
}

}  // namespace trocar::volumes

#else

namespace trocar::volumes {
const CasterKernel* caster_avx2() noexcept { return nullptr; }
}  // namespace trocar::volumes

#endif
