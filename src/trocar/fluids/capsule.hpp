// Instruments as the fluids see them: capsules that move.
#pragma once

#include <cstdint>

#include <trocar/numerics/vec3.hpp>

namespace trocar::fluids {

struct Capsule {
  Vec3f a{0, 0, 0}, b{0, 0, 0};    ///< ends of the axis [m]
  float radius = 0;                ///< [m]
  Vec3f va{0, 0, 0}, vb{0, 0, 0};  ///< their velocities [m/s]
  std::int32_t body = 0;           ///< >= 0, different from those of tissue
};

/// Finite, and of a size that an instrument can have.
bool sound(const Capsule& c) noexcept;

struct Interval {
  float low = 0, high = 0;
  bool empty() const { return !(low < high); }
};
/// Where the upright line through (x, y) lies in the capsule, in coordinates whose third is up.
Interval upright_chord(const Capsule& c, float x, float y) noexcept;

/// Nearest point of the axis to p: its share of the way from a to b, 0 .. 1.
float nearest_share(const Capsule& c, Vec3f p) noexcept;

}  // namespace trocar::fluids
