#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/paths.hpp>

namespace trocar::suture {
namespace {

/// The winding part of a throw at height y: strand A (from the lower left to the upper right) or B.
void wind(std::vector<Vec3d>& path, const Throw& t, double y, double r, double half, bool from_left, bool up) {
  // two strands turn about the axis along x by (turns + 1/2) turns, opposite each other
  const double whole = (2 * t.turns + 1) * portable::pi;
  const int pieces = 16 * (2 * t.turns + 1);
  for (int k = 0; k <= pieces; ++k) {
    const double u = double(up ? k : pieces - k) / pieces;  // 0 below, 1 above, along this strand
    const double x = from_left ? -half + 2 * half * u : half - 2 * half * u;
    const double along = from_left ? u : 1 - u;  // from the left end
    const double begin = from_left ? -portable::pi / 2 : portable::pi / 2;
    const double angle = begin + t.sign * whole * along;
    path.push_back({x, y + r * portable::sin(angle), r * portable::cos(angle)});
  }
}

}  // namespace

std::vector<Vec3d> laid_throws(const ThrowsPath& what) {
  const double r = 0.5 * what.slack * what.thickness;
  std::vector<Vec3d> path;
  const int count = int(what.throws_.size());
  const auto half_of = [&](int k) { return 4 * r * (what.throws_[std::size_t(k)].turns + 0.5); };
  const auto height = [&](int k) { return 6 * r * k; };
  // Strand A goes down, strand B up. A strand that enters a throw at the lower left leaves it at the upper right, goes
  // straight up and enters the next at the lower right.
  const double top = height(count - 1) + 3 * r;
  // which side strand B (the one that goes up) enters throw k from: it enters the first from the right
  const auto b_from_left = [&](int k) { return k % 2 == 1; };
  const auto end_of = [&](bool right) {
    const double side = right ? 1 : -1;
    return Vec3d{side * (half_of(count - 1) + what.tail), top + 0.3 * what.tail, 0};
  };
  const bool b_ends_right = b_from_left(count - 1);
  path.push_back(end_of(!b_ends_right));
  for (int k = count - 1; k >= 0; --k)
    wind(path, what.throws_[std::size_t(k)], height(k), r, half_of(k), !b_from_left(k), false);
  const double big = what.loop_radius;
  const Vec3d centre{0, -3 * r - big, 0};
  for (int k = 2; k <= 30; ++k) {
    const double angle = portable::pi / 2 + portable::two_pi * k / 32.0;
    path.push_back(centre + big * Vec3d{portable::cos(angle), portable::sin(angle), 0});
  }
  for (int k = 0; k < count; ++k)
    wind(path, what.throws_[std::size_t(k)], height(k), r, half_of(k), b_from_left(k), true);
  path.push_back(end_of(b_ends_right));
  return smoothed(path, 2);
}

std::vector<Vec3d> laid_overhand(int turns, double length, double loop_radius, double thickness) {
  // A circle whose strand is wound round itself `turns` times at its top, with ends that leave to either side.
  const double r = 0.8 * thickness, half = 4 * r * (turns + 0.5);
  std::vector<Vec3d> path;
  const double ends = 0.5 * (length - portable::two_pi * loop_radius - 4 * half);
  const Throw winding{turns, 1};
  path.push_back({half + ends, 3 * r, 0});
  wind(path, winding, 0, r, half, true, false);
  const Vec3d centre{0, -3 * r - loop_radius, 0};
  for (int k = 2; k <= 30; ++k) {
    const double angle = portable::pi / 2 + portable::two_pi * k / 32.0;
    path.push_back(centre + loop_radius * Vec3d{portable::cos(angle), portable::sin(angle), 0});
  }
  wind(path, winding, 0, r, half, false, true);
  path.push_back({-half - ends, 3 * r, 0});
  return smoothed(path, 2);
}

std::vector<Vec3d> smoothed(std::vector<Vec3d> path, int times) {
  for (int pass = 0; pass < times; ++pass) {
    std::vector<Vec3d> next{path.front()};
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      next.push_back(0.75 * path[i] + 0.25 * path[i + 1]);
      next.push_back(0.25 * path[i] + 0.75 * path[i + 1]);
    }
    next.push_back(path.back());
    path = std::move(next);
  }
  return path;
}

}  // namespace trocar::suture
