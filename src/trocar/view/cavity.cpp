#include <cmath>

#include <trocar/view/cavity.hpp>
#include <trocar/view/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr int kAround = 56, kRings = 28;

tissue::Box bounds_of(const sim::Model& model) {
  tissue::Box box;
  for (const sim::SolidModel& s : model.solids)
    for (const Vec3f& p : s.skin.rest) box.add(p);
  for (const sim::WallModel& w : model.walls)
    for (const Vec3f& p : w.skin.rest) box.add(p);
  for (const interactions::ToolModel& t : model.tools) box.add(vec_cast<float>(t.port));
  box.add(vec_cast<float>(model.scope.port));
  return box;
}

}  // namespace

MeshBuffer cavity_around(const sim::Model& model) {
  const tissue::Box box = bounds_of(model);
  const Vec3d middle = 0.5 * vec_cast<double>(box.low + box.high);
  const Vec3d half = 0.5 * vec_cast<double>(box.high - box.low) + Vec3d{0.03, 0.03, 0.03};
  const auto at = [&](Vec3d d) {
    const double uneven = 1.22 + 0.05 * waves(0.1 * d, 0.09);
    return vec_cast<float>(middle + uneven * Vec3d{half.x * d.x, half.y * d.y, half.z * d.z});
  };
  MeshBuffer b;
  b.add(at({0, 0, -1}));
  for (int i = 1; i < kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double polar = 0.5 * kTwoPi * i / kRings, a = kTwoPi * k / kAround;
      b.add(at({std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), -std::cos(polar)}));
    }
  b.add(at({0, 0, 1}));
  // Seen from inside: everything is joined the other way round.
  const auto row = [](int i) { return std::uint32_t(1 + (i - 1) * kAround); };
  join_pole(b, row(1), kAround, 0, true);
  for (int i = 1; i + 1 < kRings; ++i) join_rows(b, row(i + 1), row(i), kAround, true);
  join_pole(b, row(kRings - 1), kAround, b.size() - 1, false);
  return b;
}

}  // namespace trocar::view
