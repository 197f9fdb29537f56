#include <algorithm>

#include <trocar/collision/rods.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>

namespace trocar::collision {

Vec3d nearest_on_axis(const Capsule& capsule, Vec3d p) noexcept {
  return capsule.a + geometry::closest_on_segment(p, capsule.a, capsule.b) * (capsule.b - capsule.a);
}

double way_of(const Capsule& from, const Capsule& to) noexcept {
  return std::max(length(to.a - from.a), length(to.b - from.b));
}

bool passes_within(Vec3d from, Vec3d to, Vec3d a, Vec3d b, double radius) noexcept {
  const auto pair = geometry::closest_segments(from, to, a, b);
  const Vec3d apart = from + pair.s * (to - from) - (a + pair.t * (b - a));
  return dot(apart, apart) < radius * radius;
}

RodContact touch(const Capsule& first, const Capsule& second, Vec3f& side) noexcept {
  const auto pair = geometry::closest_segments(first.a, first.b, second.a, second.b);
  RodContact c;
  c.s = pair.s;
  c.t = pair.t;
  c.on_first = first.a + c.s * (first.b - first.a);
  c.on_second = second.a + c.t * (second.b - second.a);
  const Vec3d apart = c.on_second - c.on_first;
  const double distance = length(apart), sum = first.radius + second.radius;
  if (distance > 1e-9) c.normal = apart / distance;
  c.depth = sum - distance;
  const bool crossed = dot(c.normal, vec_cast<double>(side)) < -0.2;
  const bool beside = c.s > 0 && c.s < 1;  // not around an end of the first
  if (distance > sum + kRemember && !(crossed && beside && distance < kLost)) {
    side = {0, 0, 0};
  } else if (crossed) {
    c.normal = -c.normal;
    c.depth = sum + distance;
  } else {
    side = vec_cast<float>(c.normal);
  }
  return c;
}

namespace {

Capsule between(const Capsule& from, const Capsule& to, double share) noexcept {
  return {from.a + share * (to.a - from.a), from.b + share * (to.b - from.b), to.radius};
}

}  // namespace

RodContact touch(const Capsule& first0, const Capsule& first, const Capsule& second0, const Capsule& second,
                 Vec3f& side) noexcept {
  constexpr int kMostPlaces = 16;
  const double way = way_of(first0, first) + way_of(second0, second);
  const double most = 0.9 * (first.radius + second.radius + kRemember);
  const int places = way < kMostPlaces * most ? int(way / most) + 1 : kMostPlaces;
  for (int i = 1; i < places; ++i) {
    const double share = double(i) / places;
    touch(between(first0, first, share), between(second0, second, share), side);
  }
  return touch(first, second, side);
}

Push push_out(const Capsule& rod, Vec3d p, Vec3d n, double behind) noexcept {
  const Vec3d from_axis = p - nearest_on_axis(rod, p);
  const double out = dot(from_axis, n);
  if (out <= 0) {  // the axis is outside: straight away from it
    const double distance = length(from_axis);
    if (distance >= rod.radius) return {};
    return {rod.radius - distance, distance > 1e-6 ? from_axis / distance : -n};
  }
  const Vec3d lateral = from_axis - out * n;
  if (out > behind || length(lateral) >= rod.radius) return {};
  return {rod.radius + out, -n};
}

}  // namespace trocar::collision
