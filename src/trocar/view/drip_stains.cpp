#include <trocar/view/drip_stains.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr float kFarthest = 0.15f;                    // [m] a drop falls
constexpr float kClearance = 0.004f;                  // [m] above the middle of a stain its patches are let down from
constexpr int kPatches = 4, kSpecks = 4;              // of a stain
constexpr float kStain = 1.6e-3f, kSplash = 4.5e-3f;  // [m] how far they lie from its middle
constexpr float kPatch = 1.1e-3f, kSpeck = 0.35e-3f;  // [m] radii
constexpr float kThick = 20e-6f;                      // [m] of a patch
constexpr float kRunsDown = 2.2f;                     // [patch radii] on a steep place

}  // namespace

void DripStains::add_ground(const MeshBuffer& ground) {
  std::vector<Vec3d> rest;
  for (const Vec3f p : ground.positions) rest.push_back(vec_cast<double>(p));
  Ground g{ground.positions, {}, {}, {}};
  for (std::size_t i = 0; i + 2 < ground.indices.size(); i += 3)
    g.triangles.push_back({int(ground.indices[i]), int(ground.indices[i + 1]), int(ground.indices[i + 2])});
  if (g.triangles.empty()) return;
  g.blocks = geometry::cut_into_blocks(rest, g.triangles);
  g.boxes.resize(std::size_t(g.blocks.count()));
  geometry::refit(g.blocks, g.positions, g.boxes);
  m_grounds.push_back(std::move(g));
}

bool DripStains::land(Vec3f from, Vec3f down, Landing& at) const {
  float nearest = kFarthest;
  bool found = false;
  for (const Ground& g : m_grounds) {
    const geometry::SurfaceHit hit = geometry::first_hit(g.blocks, g.boxes, g.positions, from, down, nearest);
    if (hit.triangle < 0) continue;
    nearest = hit.t, found = true;
    at.position = from + hit.t * down;
    const auto& t = g.triangles[std::size_t(hit.triangle)];
    const Vec3f a = g.positions[std::size_t(t[0])];
    const Vec3f n = cross(g.positions[std::size_t(t[1])] - a, g.positions[std::size_t(t[2])] - a);
    at.normal = normalised(dot(n, down) > 0 ? -n : n, -down);
  }
  return found;
}

/// Patches are let down one by one, so that they lie on lobules and in grooves.
void DripStains::list_stain(Landing at, int own, render::Liquid& liquid) const {
  const Vec3f down = liquid.down;
  const auto u = [own](int which) { return float(varied(own, which)); };
  const auto add = [&](int n, float far, float radius, float thick) {
    const Vec3f level{2 * u(10 * n + 1) - 1, 2 * u(10 * n + 2) - 1, 2 * u(10 * n + 3) - 1};
    const Vec3f off = far * (level - dot(level, down) * down);
    Landing here;
    if (!land(at.position + off - kClearance * down, down, here)) return;
    render::Splat s;
    s.kind = render::SplatKind::film;
    s.from = s.to = here.position;
    s.to += (kRunsDown * radius) * (down - dot(down, here.normal) * here.normal);
    s.normal = here.normal;
    s.radius = radius * (0.6f + 0.8f * u(10 * n + 4));
    s.height = thick;
    s.dark = 1;
    liquid.splats.push_back(s);
  };
  for (int n = 0; n < kPatches; ++n) add(n, kStain, kPatch, kThick);
  for (int n = kPatches; n < kPatches + kSpecks; ++n) add(n, kSplash, kSpeck, 0.6f * kThick);
}

void DripStains::list(std::span<const Vec3f> drips, render::Liquid& liquid) const {
  for (std::size_t i = 0; i < drips.size(); ++i)
    if (Landing at; land(drips[i], liquid.down, at)) list_stain(at, 3001 + int(i), liquid);
}

}  // namespace trocar::view
