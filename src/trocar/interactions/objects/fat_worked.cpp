// What blades and current do to fat.
#include <algorithm>

#include <trocar/interactions/objects/fat.hpp>

namespace trocar::interactions {
namespace {

constexpr double kWarms = 1.2;  // spacings: lobules so near to where current enters share its heat.  Our estimate

}  // namespace

int sever_septa(const FatBody& body, const geometry::Blade& blade, tissue::FatState& s) noexcept {
  const geometry::BladePlane plane(blade);
  return plane.flat ? tissue::sever(body.fat, plane, s) : 0;
}

int lobule_at(const FatBody& body, const tissue::FatState& s, const Capsule& wire) noexcept {
  int best = -1;
  double nearest = body.fat.radius + wire.radius;
  for (int n = 0; n < body.fat.lobules(); ++n) {
    if (s.lobules[size_t(n)].gone()) continue;
    const Vec3d p = tissue::position(body.fat, s, n);
    const double apart = length(p - collision::nearest_on_axis(wire, p));
    if (apart < nearest) nearest = apart, best = n;
  }
  return best;
}

double warm_fat(const FatBody& body, int lobule, double joules, tissue::FatState& s) noexcept {
  const Vec3d middle = tissue::position(body.fat, s, lobule);
  const double reach = kWarms * body.fat.spacing;
  const auto share = [&](int n) {
    const double near = std::max(0.0, 1 - length(tissue::position(body.fat, s, n) - middle) / reach);
    return near * near;
  };
  double all = 0, boiled = 0;
  for (int n = 0; n < body.fat.lobules(); ++n)
    if (!s.lobules[size_t(n)].gone()) all += share(n);
  if (!(all > 0)) return 0;
  for (int n = 0; n < body.fat.lobules(); ++n)
    if (!s.lobules[size_t(n)].gone()) boiled += tissue::warm(body.fat, n, share(n) / all * joules, s);
  return boiled;
}

}  // namespace trocar::interactions
