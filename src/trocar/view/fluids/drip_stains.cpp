#include <algorithm>
#include <cmath>

#include <trocar/view/base/drawn_blood.hpp>
#include <trocar/view/fluids/drip_stains.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr float kStainFarthest = 0.15f;               // [m] a drop falls
constexpr float kClearance = 0.004f;                  // [m] above the ground, from where patches are let down on it
constexpr float kMerges = 0.005f;                     // [m] drops that land closer than this make one stain
constexpr int kStainPatches = 4, kSpecks = 4;         // of a stain
constexpr float kStain = 1.6e-3f, kSplash = 5.5e-3f;  // [m] how far they lie from its middle
constexpr float kPatch = 0.9e-3f, kSpeck = 0.35e-3f;  // [m] radii
constexpr float kStainThick = 34e-6f;                 // [m] of a patch
constexpr float kRunsDown = 2.2f;                     // [patch radii] on a steep place
constexpr float kStainStep = 1.2e-3f;                 // [m] between two links of a run
constexpr int kStainLinks = 11, kMoreLinks = 3;       // of one drop's run, and for every other drop
constexpr float kRunWide = 0.75e-3f;                  // [m] half its width where it begins
constexpr float kStainLevel = 0.06f;                  // slope on which it stands
constexpr float kSoaked = 3.0f;                       // radii as far as it soaks around what lies
constexpr float kSoakedThick = 1.8e-6f;               // [m] there: it stains and does not cover
constexpr float kKeeps = 0.65f;                       // share of its direction that a run keeps from link to link

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
  float nearest = kStainFarthest;
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

render::Splat DripStains::film(const Landing& from, Vec3f to, float radius, float thick) {
  render::Splat s;
  s.kind = render::SplatKind::film;
  s.from = from.position, s.to = to;
  s.normal = from.normal;
  s.radius = radius;
  s.height = thick;
  s.dark = kDrawnDark;
  return s;
}

/// A film, and a faint stain around it where it has soaked into what it lies on.
void DripStains::lay(const Landing& from, Vec3f to, float radius, float thick, render::Liquid& liquid) {
  liquid.splats.push_back(film(from, to, radius, thick));
  liquid.splats.push_back(film(from, to, kSoaked * radius, kSoakedThick));
}

bool DripStains::let_down(Vec3f at, Vec3f down, Landing& here) const {
  return land(at - kClearance * down, down, here);
}

/// Patches are let down one by one, so that they lie on lobules and in grooves.
void DripStains::list_stain(Landing at, int own, float drops, render::Liquid& liquid) const {
  const Vec3f down = liquid.down;
  const auto u = [own](int which) { return float(varied(own, which)); };
  const float grown = std::sqrt(std::min(drops, 6.0f));
  const auto add = [&](int n, float far, float radius, float thick) {
    const Vec3f level{2 * u(10 * n + 1) - 1, 2 * u(10 * n + 2) - 1, 2 * u(10 * n + 3) - 1};
    const Vec3f off = far * (level - dot(level, down) * down);
    Landing here;
    if (!let_down(at.position + off, down, here)) return;
    const float wide = radius * (0.6f + 0.8f * u(10 * n + 4));
    const Vec3f runs = (kRunsDown * radius) * (down - dot(down, here.normal) * here.normal);
    lay(here, here.position + runs, wide, thick, liquid);
  };
  for (int n = 0; n < kStainPatches; ++n) add(n, kStain * grown, kPatch * std::sqrt(grown), kStainThick);
  for (int n = kStainPatches; n < kStainPatches + kSpecks; ++n) add(n, kSplash, kSpeck, 0.4f * kStainThick);
  list_run(at, own, drops, liquid);
}

/// Blood that runs on from a stain follows the ground's fall, so that it finds furrows, and spreads where that is
/// level.
void DripStains::list_run(Landing at, int own, float drops, render::Liquid& liquid) const {
  const Vec3f down = liquid.down;
  const int links = kStainLinks + int(kMoreLinks * std::min(drops, 4.0f) + 4 * varied(own, 301));
  Vec3f way{};
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = down - dot(down, at.normal) * at.normal;
    way = kKeeps * way + (1 - kKeeps) * fall;
    Landing next;
    const float gone = float(n) / float(links);
    const bool stands = length(way) < kStainLevel || n + 1 == links;
    if (stands || !let_down(at.position + kStainStep * normalised(way, down), down, next)) {
      lay(at, at.position, 2.2f * kRunWide, 0.8f * kStainThick, liquid);
      return;
    }
    const float wide = kRunWide * (1.3f - 0.6f * gone) * (0.75f + 0.5f * float(varied(own, 310 + n)));
    lay(at, next.position, wide, kStainThick * (1 - 0.3f * gone), liquid);
    at = next;
  }
}

void DripStains::list(std::span<const Vec3f> drips, render::Liquid& liquid) const {
  struct Stain {
    Landing at;
    int own;
    float drops;
  };
  std::vector<Stain> stains;
  for (std::size_t i = 0; i < drips.size(); ++i) {
    Landing at;
    if (!land(drips[i], liquid.down, at)) continue;
    const auto near = [&](const Stain& s) { return length(s.at.position - at.position) < kMerges; };
    const auto merged = std::find_if(stains.begin(), stains.end(), near);
    if (merged != stains.end())
      merged->drops += 1;
    else
      stains.push_back({at, 3001 + int(i), 1});
  }
  for (const Stain& s : stains) list_stain(s.at, s.own, s.drops, liquid);
}

}  // namespace trocar::view
