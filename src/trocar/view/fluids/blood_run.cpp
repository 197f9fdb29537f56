#include <algorithm>
#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/blood_run.hpp>
#include <trocar/view/fluids/film_splats.hpp>

namespace trocar::view {
namespace {

// Our choice, all of them: from the look of rivulets in endoscopic films.
constexpr double kRunStep = 0.0011;               // [m] between two links
constexpr int kRunLinks = 90;                     // at most
constexpr double kSpeed = 0.016;                  // [m/s] of its lower end
constexpr double kRunLevel = 0.05;                // rise over run: blood stays there
constexpr float kWet = 0.0004f;                   // [m] so deep is the pool
constexpr int kLook = 2;                          // cells to either side, from which the fall is taken
constexpr float kRunWidth = 0.62e-3f;             // [m]
constexpr float kRunThick = 52e-6f;               // [m] above; it thins out on its way
constexpr double kWinds = 0.45, kRunWave = 0.16;  // how far it strays, a share of its way; [1/mm]

/// A place of the floor, by metres along its axes.
struct Footing {
  Vec3d point, normal;
  double along_u = 0, along_v = 0;  ///< rise over run
  bool inside = false, wet = false;
};

Footing footing(const fluids::PoolModel& m, const fluids::PoolState& pool, std::span<const float> floor, double a,
                double b) {
  Footing at;
  const int i = int(std::floor(a / m.cell)), j = int(std::floor(b / m.cell));
  at.inside = i >= kLook && j >= kLook && i + kLook + 1 < m.nx && j + kLook + 1 < m.ny;
  if (!at.inside) return at;
  const auto height = [&](int p, int q) { return double(floor_at(m, floor, p, q)); };
  at.along_u = (height(i + kLook, j) - height(i - kLook, j)) / (2 * kLook * m.cell);
  at.along_v = (height(i, j + kLook) - height(i, j - kLook)) / (2 * kLook * m.cell);
  const double du = a - (i + 0.5) * m.cell, dv = b - (j + 0.5) * m.cell;
  at.point = world(m, a, b, height(i, j) + du * at.along_u + dv * at.along_v);
  at.normal = normalised(m.up - at.along_u * m.u - at.along_v * m.v, m.up);
  at.wet = depth_at(m, pool, i, j) > kWet;
  return at;
}

}  // namespace

void list_run(const BloodRun& run, const fluids::PoolModel& m, const fluids::PoolState& pool,
              std::span<const float> floor, render::Liquid& liquid) {
  double a = dot(run.wound - m.origin, m.u), b = dot(run.wound - m.origin, m.v);
  const int links = std::min(kRunLinks, int(run.since * kSpeed / kRunStep));
  Footing at = footing(m, pool, floor, a, b);
  for (int n = 0; n < links && at.inside && !at.wet; ++n) {
    const double rise = std::hypot(at.along_u, at.along_v);
    if (rise < kRunLevel) return;
    const double level = kRunStep / std::hypot(1.0, rise),
                 wind = kWinds * std::sin(kRunWave * 1e3 * kRunStep * n * 2 + 0.7);
    a -= level / rise * (at.along_u - wind * at.along_v);
    b -= level / rise * (at.along_v + wind * at.along_u);
    const Footing next = footing(m, pool, floor, a, b);
    if (!next.inside) return;
    const float gone = float(n) / float(kRunLinks), bulge = n + 2 >= links ? 1.5f : 1.0f;
    render::Splat s;
    s.kind = render::SplatKind::film;
    s.from = vec_cast<float>(at.point), s.to = vec_cast<float>(next.point);
    s.normal = vec_cast<float>(at.normal);
    s.radius = kRunWidth * bulge * (1 + 0.35f * own(std::uint32_t(n), 3));
    s.height = kRunThick * (1 - 0.4f * gone) * (1 + 0.3f * own(std::uint32_t(n), 4));
    s.dark = run.dark;
    liquid.splats.push_back(s);
    at = next;
  }
}

}  // namespace trocar::view
