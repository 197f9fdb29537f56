#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/scene/description/vary.hpp>

namespace trocar::scene {
namespace {

double smooth(double from, double to, double v) {
  const double t = std::clamp((v - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// One side's displacement of space: scaled about the tube's root and shifted, nothing at the uterus and far away.
struct Field {
  Vec3d root;
  double side = 1;  ///< +1: the patient's left
  double scale = 0;
  Vec3d shift;

  Vec3d at(Vec3d p) const {
    constexpr double kBegins = -0.001, kWhole = 0.016;  // [m] to the side of the root
    constexpr double kNear = 0.055, kFar = 0.120;       // [m] from the root: fades in between
    const Vec3d d = p - root;
    const double weight = smooth(kBegins, kWhole, side * d.x) * (1 - smooth(kNear, kFar, length(d)));
    return weight * (scale * d + shift);
  }
};

struct Warp {
  std::vector<Field> fields;

  Vec3d operator()(Vec3d p) const {
    Vec3d moved = p;
    for (const Field& f : fields) moved += f.at(p);
    return moved;
  }
  /// What becomes of a small vector at p.
  Vec3d along(Vec3d p, Vec3d v) const { return 0.5 * ((*this)(p + v) - (*this)(p - v)); }
};

/// Arc length at each point of a spline through `points`.
std::vector<double> arc_at_points(const std::vector<Vec3d>& points) {
  constexpr int kSamples = 2000;
  const geometry::NurbsCurve curve = geometry::interpolated(points);
  const double whole = geometry::length(curve);
  const std::vector<Vec3d> samples = geometry::sampled_by_arc(curve, kSamples + 1);
  std::vector<double> arc;
  size_t from = 0;
  for (const Vec3d& p : points) {
    size_t best = from;
    for (size_t i = from; i < samples.size(); ++i)
      if (length(samples[i] - p) < length(samples[best] - p)) best = i;
    from = best;
    arc.push_back(whole * double(best) / kSamples);
  }
  return arc;
}

/// Where a place at arc length `s` of the drawn strand comes to lie: linear between the points of its centre line.
struct ArcMap {
  std::vector<double> before, after;

  double operator()(double s) const {
    for (size_t i = 1; i < before.size(); ++i) {
      if (s > before[i] && i + 1 < before.size()) continue;
      const double share = (s - before[i - 1]) / std::max(before[i] - before[i - 1], 1e-9);
      return std::max(0.0, after[i - 1] + share * (after[i] - after[i - 1]));
    }
    return s;
  }
};

ArcMap bend(Strand& strand, const Warp& warp) {
  ArcMap map;
  if (strand.centreline.size() < 2) return map;
  map.before = arc_at_points(strand.centreline);
  for (Vec3d& p : strand.centreline) p = warp(p);
  map.after = arc_at_points(strand.centreline);
  for (StrandStation& s : strand.stations) s.s = map(s.s);
  for (Landmark& l : strand.landmarks) {
    l.from = map(l.from);
    l.to = map(l.to);
  }
  return map;
}

void bend(Solid& solid, const Warp& warp) {
  for (Section& s : solid.sections) {
    s.across = warp.along(s.centre, s.across);
    s.deep = warp.along(s.centre, s.deep);
    s.centre = warp(s.centre);
  }
  if (solid.tets)
    for (Vec3d& p : solid.tets->mesh.points) p = warp(p);
  for (Anchor& a : solid.anchors) a.centre = warp(a.centre);
}

void bend(Pouch& pouch, const Warp& warp) {
  for (Section& s : pouch.sections) {
    s.across = warp.along(s.centre, s.across);
    s.deep = warp.along(s.centre, s.deep);
    s.centre = warp(s.centre);
  }
  for (Anchor& a : pouch.held) a.centre = warp(a.centre);
}

double chords(const std::vector<Vec3d>& points) {
  double sum = 0;
  for (size_t i = 1; i < points.size(); ++i) sum += length(points[i] - points[i - 1]);
  return sum;
}

/// Its blood has farther to go where its path is longer; calibre and wall stay.
void bend(Vessel& vessel, vessels::VesselSegment& segment, const Warp& warp) {
  const double before = chords(vessel.path);
  for (Vec3d& p : vessel.path) p = warp(p);
  if (before > 0) segment.length *= chords(vessel.path) / before;
}

double around_one(core::Random& random, double most) { return 1 + random.uniform(-most, most); }

Warp drawn_warp(const Description& d, core::Random& random, const Variation& most) {
  Warp warp;
  for (const double side : {1.0, -1.0}) {  // both are drawn, whether the scene has them or not
    Field field;
    field.side = side;
    field.scale = random.uniform(-most.length, most.length);
    for (double* axis : {&field.shift.x, &field.shift.y, &field.shift.z})
      *axis = random.uniform(-most.shift, most.shift);
    for (const Strand& s : d.strands) {
      if (!s.fimbriated || s.centreline.empty() || side * s.centreline.back().x <= 0) continue;
      field.root = s.centreline.front();
      warp.fields.push_back(field);
      break;
    }
  }
  return warp;
}

}  // namespace

void vary(Description& d, std::uint64_t seed, const Variation& most) {
  if (seed == 0) return;
  core::Random random(seed);
  const Warp warp = drawn_warp(d, random, most);
  for (Tissue& t : d.tissues) t.young *= around_one(random, most.stiffness);
  std::vector<ArcMap> maps;
  for (Strand& s : d.strands) {
    s.foundation *= around_one(random, most.stiffness);
    maps.push_back(bend(s, warp));
  }
  for (Solid& s : d.solids) bend(s, warp);
  for (Pouch& p : d.pouches) bend(p, warp);
  for (Wall& w : d.walls)
    for (Vec3d& p : w.net) p = warp(p);
  const auto bend_fold = [&](auto& fold) {
    for (size_t i = 0; i < d.strands.size(); ++i) {
      if (d.strands[i].name != fold.strand || maps[i].before.empty()) continue;
      fold.from = maps[i](fold.from);
      fold.to = maps[i](fold.to);
    }
    for (Vec3d& p : fold.base) p = warp(p);
  };
  for (VesselTree& tree : d.vessels)
    for (size_t i = 0; i < tree.vessels.size(); ++i) bend(tree.vessels[i], tree.graph.segments[i], warp);
  for (WaveSetting& wave : d.peristalsis)
    for (Vec3d& p : wave.centreline) p = warp(p);
  if (d.bleeder) d.bleeder->which = int(random.uniform() * double(d.bleeder->holes.size()));
  for (Sheet& sheet : d.sheets) bend_fold(sheet);
  for (Membrane& membrane : d.membranes) bend_fold(membrane);
}

}  // namespace trocar::scene
