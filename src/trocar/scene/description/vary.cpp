#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/description/variant.hpp>
#include <trocar/scene/description/vary.hpp>

namespace trocar::scene {
namespace {

double smooth(double from, double to, double v) {
  const double t = std::clamp((v - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// What a seed made of a region: a displacement of space about its middle, nothing far away.
struct Field {
  VariationSetting::Region region;
  Vec3d root, towards, axis;  ///< the directions are units, `towards` may be zero
  double scale = 0, length = 0, turn = 0;
  Vec3d shift;

  Vec3d at(Vec3d p) const {
    const Vec3d d = p - root;
    const bool sided = trocar::length(towards) > 0;
    const double aside = sided ? smooth(region.begins, region.whole, dot(towards, d)) : 1;
    const double weight = aside * (1 - smooth(region.near, region.far, trocar::length(d)));
    Vec3d moved = scale * d + shift;
    if (length != 0) moved += length * dot(axis, d) * axis;
    if (turn != 0) moved += turned(d) - d;
    return weight * moved;
  }

 private:
  Vec3d turned(Vec3d d) const {
    const double c = portable::cos(turn), s = portable::sin(turn);
    return c * d + s * cross(axis, d) + (1 - c) * dot(axis, d) * axis;
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

void bend(ClosedShape& shape, const Warp& warp) {
  if (shape.revolved) {  // what is bent is none any more
    try {
      shape.nurbs = shape_of(surface_of(*shape.revolved));
      shape.revolved.reset();
    } catch (const std::invalid_argument&) {  // compile says what is wrong with it
    }
  }
  if (shape.surface)
    for (Vec3d& p : shape.surface->mesh.positions) p = warp(p);
  if (shape.nurbs)
    for (Vec3d& p : shape.nurbs->net) p = warp(p);
  if (!shape.tube || shape.tube->line.size() < 2) return;
  ArcMap map;
  map.before = arc_at_points(shape.tube->line);
  for (Vec3d& p : shape.tube->line) p = warp(p);
  map.after = arc_at_points(shape.tube->line);
  for (TubeShape::Station& s : shape.tube->stations) s.s = map(s.s);
}

void bend(std::vector<StiffnessRegion>& regions, const Warp& warp) {
  for (StiffnessRegion& r : regions) r.centre = warp(r.centre);
}

void bend(Solid& solid, const Warp& warp) {
  bend(solid.shape, warp);
  for (Section& s : solid.sections) {
    s.across = warp.along(s.centre, s.across);
    s.deep = warp.along(s.centre, s.deep);
    s.centre = warp(s.centre);
  }
  if (solid.tets)
    for (Vec3d& p : solid.tets->mesh.points) p = warp(p);
  for (Anchor& a : solid.anchors) a.centre = warp(a.centre);
  bend(solid.regions, warp);
  for (Stroke& stroke : solid.fibre_strokes)
    for (Vec3d& p : stroke) p = warp(p);
}

void bend(Pouch& pouch, const Warp& warp) {
  bend(pouch.shape, warp);
  for (Section& s : pouch.sections) {
    s.across = warp.along(s.centre, s.across);
    s.deep = warp.along(s.centre, s.deep);
    s.centre = warp(s.centre);
  }
  for (Anchor& a : pouch.held) a.centre = warp(a.centre);
  bend(pouch.regions, warp);
  for (BondSetting& bonds : pouch.bonds)
    for (Anchor& place : bonds.places) place.centre = warp(place.centre);
}

double chords(const std::vector<Vec3d>& points) {
  double sum = 0;
  for (size_t i = 1; i < points.size(); ++i) sum += length(points[i] - points[i - 1]);
  return sum;
}

/// Its blood has further to go where its path is longer; calibre and wall stay.
void bend(Vessel& vessel, vessels::VesselSegment& segment, const Warp& warp) {
  const double before = chords(vessel.path);
  for (Vec3d& p : vessel.path) p = warp(p);
  if (before > 0) segment.length *= chords(vessel.path) / before;
}

double around_one(core::Random& random, double most) { return 1 + random.uniform(-most, most); }

/// The middle of what a region is around; none where there is no such body.
std::optional<Vec3d> middle_of(const VariationSetting::Region& region, const Description& d) {
  if (region.around.empty()) return region.centre;
  for (const Strand& s : d.strands)
    if (s.name == region.around && !s.centreline.empty()) return s.centreline.front();
  for (const Solid& s : d.solids) {
    if (s.name != region.around) continue;
    std::vector<Vec3d> points;
    for (const Section& section : s.sections) points.push_back(section.centre);
    if (s.tets) points = s.tets->mesh.points;
    if (s.shape.surface) points = s.shape.surface->mesh.positions;
    if (s.shape.nurbs) points = s.shape.nurbs->net;
    if (s.shape.tube) points = s.shape.tube->line;
    if (s.shape.revolved) points = {s.shape.revolved->from};
    Vec3d sum;
    for (const Vec3d& p : points) sum += p;
    if (!points.empty()) return sum / double(points.size());
  }
  return {};
}

Warp drawn_warp(const Description& d, core::Random& random) {
  Warp warp;
  for (const VariationSetting::Region& region : d.variation->regions) {
    Field field;
    field.region = region;
    if (length(region.towards) > 0) field.towards = normalised(region.towards);
    field.axis = normalised(region.axis);
    const auto draw = [&](double most) { return most > 0 ? random.uniform(-most, most) : 0; };
    field.scale = draw(region.scale);
    for (double* axis : {&field.shift.x, &field.shift.y, &field.shift.z}) *axis = draw(region.shift);
    field.length = draw(region.length);
    field.turn = draw(region.turn);
    const std::optional<Vec3d> middle = middle_of(region, d);
    if (!middle) continue;
    field.root = *middle;
    warp.fields.push_back(field);
  }
  return warp;
}

/// Across the body, about the middles of its rows or its axis; a surface from a file has neither.
void thicken(ClosedShape& shape, double share) {
  if (shape.tube)
    for (TubeShape::Station& s : shape.tube->stations) s.radius *= share, s.wall *= share;
  if (shape.revolved)
    for (RevolvedShape::ProfilePoint& p : shape.revolved->profile) p.r *= share;
  if (!shape.nurbs || shape.nurbs->columns < 1) return;
  const auto columns = std::ptrdiff_t(shape.nurbs->columns);
  for (auto row = shape.nurbs->net.begin(); shape.nurbs->net.end() - row >= columns; row += columns) {
    Vec3d middle;
    std::for_each(row, row + columns, [&](Vec3d p) { middle += p / double(columns); });
    std::for_each(row, row + columns, [&](Vec3d& p) { p = middle + share * (p - middle); });
  }
}

/// Everything of this name, by the same share.
void thicken(Description& d, const std::string& name, double share) {
  const auto sections = [&](auto& body) {
    if (body.name != name) return;
    for (Section& s : body.sections) s.across = share * s.across, s.deep = share * s.deep;
    thicken(body.shape, share);
  };
  for (Solid& s : d.solids) sections(s);
  for (Pouch& p : d.pouches) sections(p);
  for (Strand& s : d.strands)
    if (s.name == name)
      for (StrandStation& at : s.stations) at.radius *= share, at.lumen *= share;
  for (Membrane& m : d.membranes)
    if (m.name == name) m.thickness *= share;
}

/// Everything that is drawn goes along with space.
void bend(Description& d, const Warp& warp) {
  std::vector<ArcMap> maps;
  for (Strand& s : d.strands) maps.push_back(bend(s, warp));
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
  for (MarkSetting& mark : d.marks) {
    mark.place = warp(mark.place);
    for (size_t i = 0; i < d.strands.size(); ++i)
      if (mark.stripe && d.strands[i].name == mark.on && !maps[i].before.empty()) mark.s = maps[i](mark.s);
  }
  for (Sheet& sheet : d.sheets) bend_fold(sheet);
  for (Membrane& membrane : d.membranes) bend_fold(membrane);
  ObjectScenes::for_each([&](auto kind) { kind.bend(settings_of(kind, d.objects), warp); });
}

/// The lumen about the finding's mark, narrowest in its middle. Along the organ, not through space: loops lie side by
/// side.
void narrow(Description& d, const VariationSetting::Finding& finding) {
  const auto is_it = [&](const MarkSetting& m) { return m.name == finding.mark; };
  const auto mark = std::find_if(d.marks.begin(), d.marks.end(), is_it);
  if (mark == d.marks.end()) return;
  for (Solid& solid : d.solids) {
    if (solid.name != finding.solid || solid.sections.empty()) continue;
    std::vector<double> way{0};
    std::size_t middle = 0;
    for (std::size_t i = 0; i < solid.sections.size(); ++i) {
      const Vec3d here = solid.sections[i].centre;
      if (i > 0) way.push_back(way.back() + length(here - solid.sections[i - 1].centre));
      if (length(here - mark->place) < length(solid.sections[middle].centre - mark->place)) middle = i;
    }
    for (std::size_t i = 0; i < way.size(); ++i) {
      const double away = std::fabs(way[i] - way[middle]) / finding.over, left = std::max(0.0, 1 - away * away);
      Section& s = solid.sections[i];
      s.across = (1 - finding.narrower * left * left) * s.across;
      s.deep = (1 - finding.narrower * left * left) * s.deep;
    }
  }
}

void leave_out(Description& d, const VariationSetting::Finding& absent) {
  const auto goes = [&](const MarkSetting& m) {
    return m.name == absent.mark || std::find(absent.with.begin(), absent.with.end(), m.name) != absent.with.end();
  };
  d.marks.erase(std::remove_if(d.marks.begin(), d.marks.end(), goes), d.marks.end());
}

/// Leaves so many of the findings as the scene says, drawn without putting back, and of those that have a share each as
/// often as that says. Of its own numbers, so that all else is drawn as if there were none.
void find(Description& d, std::uint64_t seed) {
  std::vector<VariationSetting::Finding> left;
  core::Random frequent(seed ^ 0x20e3'1e5ull);
  for (const VariationSetting::Finding& f : d.variation->findings) {
    if (f.share <= 0)
      left.push_back(f);
    else if (const double drawn = frequent.uniform(); seed != 0 && drawn >= f.share)
      leave_out(d, f);
  }
  core::Random random(seed ^ 0xf1d1'465eull);
  for (int i = 0; i < d.variation->present && !left.empty(); ++i) {
    const std::size_t which =
        seed == 0 ? 0 : std::min(left.size() - 1, std::size_t(random.uniform() * double(left.size())));
    if (left[which].narrower > 0) narrow(d, left[which]);
    left.erase(left.begin() + std::ptrdiff_t(which));
  }
  for (const VariationSetting::Finding& absent : left) leave_out(d, absent);
}

/// The variant that the scene asks for, or that the seed draws.
void vary_anatomy(Description& d, std::uint64_t seed) {
  if (d.variation->variants.empty()) return;
  const VariationSetting variation = *d.variation;  // the scene changes
  const VariationSetting::Variant* variant =
      d.variant.empty() ? drawn_variant(variation, seed) : find_variant(variation, d.variant);
  d.anatomy = variant ? variant->name : kCommonAnatomy;
  if (variant) put_in(d, *variant);
}

}  // namespace

void vary(Description& d, std::uint64_t seed) {
  for (std::size_t i = 0; i < d.ports.size(); ++i) d.ports[i].seed = core::Random(seed + i).next();
  if (!d.variation) return;
  const std::size_t strands = d.strands.size();
  vary_anatomy(d, seed);
  if (!d.variation->findings.empty()) find(d, seed);
  if (seed == 0) return;
  const VariationSetting& most = *d.variation;
  core::Random random(seed);
  const Warp warp = drawn_warp(d, random);
  if (most.stiffness > 0)
    for (Tissue& t : d.tissues) t.young *= around_one(random, most.stiffness);
  core::Random others(seed ^ 0x57a4'd5ull);  // of strands that only this anatomy has: the rest is drawn as ever
  for (std::size_t i = 0; most.foundation > 0 && i < d.strands.size(); ++i)
    d.strands[i].foundation *= around_one(i < strands ? random : others, most.foundation);
  if (most.bleeder && d.bleeder) d.bleeder->which = int(random.uniform() * double(d.bleeder->holes.size()));
  if (!warp.fields.empty()) bend(d, warp);
  for (const VariationSetting::Girth& girth : most.girths) {
    const double share = around_one(random, girth.radius);
    for (const std::string& name : girth.of) thicken(d, name, share);
  }
}

}  // namespace trocar::scene
