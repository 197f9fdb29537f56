#include <algorithm>

#include <trocar/tissue/heat/heat_look.hpp>

namespace trocar::tissue {
namespace {

constexpr Vec3f kPale{222 / 255.0f, 205 / 255.0f, 185 / 255.0f};
constexpr Vec3f kTan{170 / 255.0f, 130 / 255.0f, 95 / 255.0f};
constexpr Vec3f kBrown{60 / 255.0f, 40 / 255.0f, 25 / 255.0f};
constexpr Vec3f kBlack{25 / 255.0f, 20 / 255.0f, 18 / 255.0f};

float ramp(float from, float to, float x) noexcept { return std::clamp((x - from) / (to - from), 0.0f, 1.0f); }
Vec3f mix(Vec3f a, Vec3f b, float share) noexcept { return (1 - share) * a + share * b; }

}  // namespace

HeatLook look(const HeatReading& r) noexcept {
  HeatLook l;
  l.pale = std::clamp(r.coagulated, 0.0f, 1.0f);
  l.tan = l.pale * std::max(ramp(80, 95, r.peak), ramp(1, 0.3f, r.water));
  l.char_ = ramp(150, 200, r.peak);
  l.steam = ramp(80, 95, r.temperature) * ramp(0, 0.05f, r.water);
  return l;
}

Vec3f colour(const HeatLook& l, Vec3f natural) noexcept {
  const Vec3f cooked = mix(mix(natural, kPale, l.pale), kTan, l.tan);
  return l.char_ < 0.5f ? mix(cooked, kBrown, 2 * l.char_) : mix(kBrown, kBlack, 2 * l.char_ - 1);
}

float stiffness(const HeatReading& r) noexcept { return 1 + 3 * r.coagulated + 6 * (1 - r.water) * r.coagulated; }

float shrinkage(const HeatReading& r) noexcept { return 1 - 0.1f * r.coagulated - 0.1f * (1 - r.water); }

}  // namespace trocar::tissue
