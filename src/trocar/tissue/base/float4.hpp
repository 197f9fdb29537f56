// Four floats in a register, of which three count: a node's place or velocity, read and computed with whole. Vectors of
// the compiler, so the same everywhere, bit for bit what three floats would give. Private to the folder.
#pragma once

#include <cstdint>
#include <cstring>

#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));

/// Reads four floats.
inline Float4 load4(const float* p) noexcept {
  Float4 a;
  std::memcpy(&a, p, sizeof a);
  return a;
}
inline Float4 load4(Vec3f a) noexcept { return Float4{a.x, a.y, a.z, 0}; }
inline Vec3f vec3(Float4 a) noexcept { return {a[0], a[1], a[2]}; }

inline Float4 pick(Int4 mask, Float4 a, Float4 b) noexcept { return (Float4)((mask & (Int4)a) | (~mask & (Int4)b)); }
inline Float4 smaller(Float4 a, Float4 b) noexcept { return pick(a < b, a, b); }
inline Float4 larger(Float4 a, Float4 b) noexcept { return pick(a > b, a, b); }

}  // namespace trocar::tissue
