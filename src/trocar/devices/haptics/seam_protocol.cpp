#include <cmath>

#include <trocar/devices/haptics/bytes.hpp>
#include <trocar/devices/haptics/seam_protocol.hpp>

namespace trocar::devices {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr char kSampleMark[] = "TRS1", kForceMark[] = "TRF1", kAbilityMark[] = "TRA1";
constexpr double kMostForce = 100, kMostStiffness = 1e5, kMostDamping = 1000, kFarthest = 1;
constexpr std::uint32_t kTurns = 1, kGrips = 2;

bool marked(Bytes d, const char* mark, std::size_t size) {
  return d.size() == size && std::memcmp(d.data(), mark, 4) == 0;
}

/// Doubles that follow each other.
struct Reader {
  const std::uint8_t* at;
  double next() {
    const double value = get_f64(at);
    at += 8;
    return value;
  }
  Vec3d vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
};
struct Writer {
  std::uint8_t* at;
  void next(double value) {
    put_f64(at, value);
    at += 8;
  }
  void vector(Vec3d v) { next(v.x), next(v.y), next(v.z); }
};

bool within(double value, double most) { return std::isfinite(value) && value >= 0 && value <= most; }

}  // namespace

std::optional<HapticSample> read_sample(Bytes d) noexcept {
  if (!marked(d, kSampleMark, kSampleBytes)) return {};
  HapticSample s;
  s.number = get_u32(d.data() + 4);
  Reader r{d.data() + 8};
  s.position = r.vector();
  s.rotation.w = r.next(), s.rotation.x = r.next(), s.rotation.y = r.next(), s.rotation.z = r.next();
  s.grip = r.next();
  s.switches = get_u32(r.at);
  if (!plausible(s)) return {};
  return s;
}

void write_sample(std::span<std::uint8_t, kSampleBytes> to, const HapticSample& s) noexcept {
  std::memcpy(to.data(), kSampleMark, 4);
  put_u32(to.data() + 4, s.number);
  Writer w{to.data() + 8};
  w.vector(s.position);
  w.next(s.rotation.w), w.next(s.rotation.x), w.next(s.rotation.y), w.next(s.rotation.z);
  w.next(s.grip);
  put_u32(w.at, s.switches);
  put_u32(w.at + 4, 0);
}

std::optional<HapticCapabilities> read_abilities(Bytes d) {
  if (!marked(d, kAbilityMark, kAbilityBytes)) return {};
  HapticCapabilities c;
  c.name = "seam";
  const std::uint32_t flags = get_u32(d.data() + 4);
  c.turns = (flags & kTurns) != 0;
  c.grips = (flags & kGrips) != 0;
  Reader r{d.data() + 8};
  c.force_max = r.next(), c.stiffness_max = r.next(), c.damping_max = r.next();
  c.own_damping = r.next(), c.own_friction = r.next(), c.resolution = r.next();
  c.reach = r.vector();
  const bool good = within(c.force_max, kMostForce) && within(c.stiffness_max, kMostStiffness) &&
                    within(c.damping_max, kMostDamping) && within(c.own_damping, kMostDamping) &&
                    within(c.own_friction, kMostForce) && within(c.resolution, kFarthest) &&
                    within(c.reach.x, kFarthest) && within(c.reach.y, kFarthest) && within(c.reach.z, kFarthest);
  if (!good) return {};
  return c;
}

void write_abilities(std::span<std::uint8_t, kAbilityBytes> to, const HapticCapabilities& c) noexcept {
  std::memcpy(to.data(), kAbilityMark, 4);
  put_u32(to.data() + 4, (c.turns ? kTurns : 0) | (c.grips ? kGrips : 0));
  Writer w{to.data() + 8};
  w.next(c.force_max), w.next(c.stiffness_max), w.next(c.damping_max);
  w.next(c.own_damping), w.next(c.own_friction), w.next(c.resolution);
  w.vector(c.reach);
}

void write_force(std::span<std::uint8_t, kForceBytes> to, std::uint32_t number, const HapticForce& f) noexcept {
  std::memcpy(to.data(), kForceMark, 4);
  put_u32(to.data() + 4, number);
  Writer w{to.data() + 8};
  w.vector(f.force);
  w.vector(f.torque);
  w.next(f.grip);
}

std::optional<HapticForce> read_force(Bytes d, std::uint32_t& number) noexcept {
  if (!marked(d, kForceMark, kForceBytes)) return {};
  number = get_u32(d.data() + 4);
  Reader r{d.data() + 8};
  HapticForce f;
  f.force = r.vector();
  f.torque = r.vector();
  f.grip = r.next();
  return f;
}

}  // namespace trocar::devices
