#include <algorithm>

#include <trocar/interactions/couplings/coupled.hpp>

namespace trocar::interactions {

Coupled::Coupled(const Bodies& bodies, const MaterialPoint& n, const MaterialPoint& f) noexcept
    : near(n),
      far(f),
      x(place_of(bodies, n)),
      v(velocity_of(bodies, n)),
      at(place_of(bodies, f)),
      moves(velocity_of(bodies, f)),
      apart(x - at) {}

void couple(const Bodies& bodies, const Coupled& ends, const SpringDamper& law, double dt, Tag tag) noexcept {
  const Vec3d drawn = -law.whole * law.drawn;
  put_load(bodies, ends.near, {.f0 = drawn, .k = law.k, .target = ends.at, .d = law.d, .u = ends.moves}, tag);
  const Vec3d pull = law.k * ends.apart + law.d * (ends.v - ends.moves) - (1 - law.whole) * law.drawn;
  bear(bodies, ends.far, pull, resistance_of(law.k, law.d, dt), tag);
}

void bear(const Bodies& bodies, const MaterialPoint& far, Vec3d pull, double resists, Tag tag) noexcept {
  if (far.in_space()) return;
  put_load(bodies, far, {.f0 = pull, .d = resists, .u = velocity_of(bodies, far)}, tag);
}

void end_load(const Bodies& bodies, const Attachment& on, const tissue::StrandReaction& reaction, double dt) noexcept {
  const Mat3d& t = reaction.tangent;
  const double k = std::max(0.0, t.m[0][0] + t.m[1][1] + t.m[2][2]);
  bear(bodies, on.point, reaction.force - on.drawn_pull, k * dt, {Owner::anchor, 0, 0});
}

}  // namespace trocar::interactions
