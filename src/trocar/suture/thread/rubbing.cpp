// Friction after a solve: strains follow the motion, what is beyond their bounds has slipped.
#include <algorithm>

#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

/// What the solve says of a touch: its press, its friction, and what of the motion was taken.
void end_touch(Touch& touch, Vec3d motion, double share) {
  const double apart = dot(motion, touch.normal);
  const Vec3d along = motion - apart * touch.normal;
  const double before = touch.press;
  touch.press = std::max(0.0, before - touch.stiffness * apart);
  touch.force = touch.press * touch.normal - touch.rub_stiffness * (touch.strain + along);
  touch.strain += share * along;
}

void remember(const Touch* touches, int count, std::vector<ElementRub>& rubs, std::int32_t& kept) {
  kept = count;
  for (int k = 0; k < count; ++k)
    rubs[k] = {touches[k].a, touches[k].b, {touches[k].strain, touches[k].reached}, touches[k].press};
}

}  // namespace

void settle(Touch& touch) noexcept {
  touch.reached = length(touch.strain);
  if (touch.reached > touch.bound) touch.strain *= touch.bound / touch.reached;
}

void end_touches(Tick& t, double share) noexcept {
  for (int k = 0; k < t.self; ++k) {
    Touch& touch = t.w.self[k];
    const Vec3d a = (1 - touch.s) * t.w.delta[touch.a] + touch.s * t.w.delta[touch.a + 1];
    const Vec3d b = (1 - touch.t) * t.w.delta[touch.b] + touch.t * t.w.delta[touch.b + 1];
    end_touch(touch, a - b, share);
  }
  for (int k = 0; k < t.touching; ++k) {
    Touch& touch = t.w.touch[k];
    const Vec3d a = (1 - touch.s) * t.w.delta[touch.a] + touch.s * t.w.delta[touch.a + 1];
    end_touch(touch, a - touch.moved, share);
  }
}

void settle_touches(Tick& t) noexcept {
  for (int k = 0; k < t.self; ++k) settle(t.w.self[k]);
  for (int k = 0; k < t.touching; ++k) settle(t.w.touch[k]);
  remember(t.w.self.data(), t.self, t.s.self, t.s.self_count);
  remember(t.w.touch.data(), t.touching, t.s.touch, t.s.touch_count);
}

}  // namespace trocar::suture
