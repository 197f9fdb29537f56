#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile_hands.hpp>
#include <trocar/scene/compile/compile_vessels.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/model/attach_near.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

using interactions::VesselPath;
using interactions::VesselPoint;
using Faults = std::vector<core::Fault>;

constexpr double kFades = 0.030;   // [m] within which what nothing carries no longer goes with what is carried
constexpr double kDeep = 0.030;    // [m] within an organ a vessel may be so deep
constexpr double kWall = 1.25;     // outer radius of a vessel over that of its lumen.  Our choice
constexpr double kSettle = 10;     // [s] of heartbeat before the first tick ...
constexpr double kAverage = 5;     // ... and of those after which the mean pressures are taken
constexpr int kFewSegments = 500;  // more have as many seconds less

/// All of a scene's vessels as one graph. Where the scene breathes, the arteries do with it.
vessels::VesselGraph joined(const Description& d) {
  vessels::VesselGraph all;
  for (const VesselTree& tree : d.vessels) {
    const int first = all.nodes;
    if (&tree == &d.vessels.front()) {
      all.heart = tree.graph.heart;
      all.blood = tree.graph.blood;
    }
    all.nodes += tree.graph.nodes;
    for (vessels::VesselSegment s : tree.graph.segments) {
      s.from += first, s.to += first;
      all.segments.push_back(s);
    }
    for (vessels::VesselEnd e : tree.graph.ends) {
      e.node += first;
      all.ends.push_back(e);
    }
    for (vessels::VesselSource s : tree.graph.sources) {
      s.node += first;
      all.sources.push_back(s);
    }
  }
  all.settings.tick = sim::kTick;
  all.settings.max_openings = interactions::kMaxOpenings;
  // What heat seals is closed as by clips, at both ends.
  all.settings.max_clips = interactions::kMaxVesselClips + (d.energy ? 2 * interactions::kMaxSeals : 0);
  // A drug that is injected narrows small ones, as partial clips at both ends would.
  const auto injects = [](const Instrument& i) { return i.can().inject; };
  if (std::any_of(d.instruments.begin(), d.instruments.end(), injects))
    all.settings.max_clips += 2 * int(all.segments.size());
  if (has_slings(settings_of(SutureScene{}, d.objects))) all.settings.max_clips += sim::kMostLoops;
  if (d.breathing) all.heart.breaths = d.breathing->per_minute;
  return all;
}

/// A point of a body, and how far that is from where it shall be.
struct Ride {
  interactions::MaterialPoint point;
  double distance = 1e30;
};

Ride ride_on_rod(const interactions::Bodies& bodies, size_t rod, Vec3d p) {
  const interactions::MaterialPoint point = attach(bodies, BodyId::strand(rod), p);
  const double radius = bodies.strand(rod).model.radius[size_t(point.element)];
  return {point, length(p - foot_of(bodies, point)) - radius};
}

Ride ride_on_membrane(const interactions::Bodies& bodies, size_t membrane, Vec3d p) {
  const interactions::MaterialPoint point = attach(bodies, BodyId::membrane(membrane), p);
  return {point, length(p - foot_of(bodies, point))};
}

/// Within a lattice every depth up to kDeep is as good.
Ride ride_on_lattice(const interactions::Bodies& bodies, size_t organ, Vec3d p) {
  const tissue::Skin& skin = bodies.models.skin(int(organ));
  double least = 1e30, distance = 0;
  for (const std::array<int, 3>& t : skin.triangles) {
    const auto x = [&](size_t k) { return vec_cast<double>(skin.rest[size_t(t[k])]); };
    const auto near = geometry::closest_on_triangle(p, x(0), x(1), x(2));
    if (near.distance2 >= least) continue;
    least = near.distance2;
    distance = std::sqrt(near.distance2);
    if (dot(p - near.point, cross(x(1) - x(0), x(2) - x(0))) < 0 && distance < kDeep) distance = 0;
  }
  return {attach(bodies, BodyId::organ(organ), p), distance};
}

/// How far outside of the nearest cell: its most negative share times its height there is at least the distance.
double outside_of_cells(const geometry::CuttableTets& body, Vec3d p) {
  double least = 1e30;
  for (const geometry::Tet& cell : body.cells) {
    const auto x = [&](size_t k) { return body.rest[size_t(cell[k])]; };
    const Vec3d u = x(1) - x(0), v = x(2) - x(0), w = x(3) - x(0), q = p - x(0);
    const double volume = dot(u, cross(v, w));
    const double b = dot(q, cross(v, w)) / volume, d = dot(u, cross(q, w)) / volume, e = dot(u, cross(v, q)) / volume;
    const std::array<double, 4> share{1 - b - d - e, b, d, e};
    double distance = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (share[k] >= 0) continue;
      const Vec3d f = x((k + 1) % 4), g = x((k + 2) % 4), h = x((k + 3) % 4);
      distance = std::max(distance, -share[k] * std::fabs(volume) / length(cross(g - f, h - f)));
    }
    least = std::min(least, distance);
  }
  return least;
}

Ride ride_on(const interactions::Bodies& bodies, BodyId body, Vec3d p) {
  if (body.is(BodyKind::strand)) return ride_on_rod(bodies, body.index(), p);
  if (body.is(BodyKind::membrane)) return ride_on_membrane(bodies, body.index(), p);
  if (!is_tetrahedral(bodies, body)) return ride_on_lattice(bodies, body.index(), p);
  return {attach(bodies, body, p), outside_of_cells(tets_of(bodies, body), p)};
}

Ride nearest_ride(const interactions::Bodies& bodies, const std::vector<BodyId>& carriers, double reach, Vec3d p) {
  Ride best{interactions::in_space(p), reach};
  for (const BodyId body : carriers)
    if (Ride ride = ride_on(bodies, body, p); ride.distance < best.distance) best = ride;
  return best;
}

/// The one of the scene's holes that opens.
sim::Bleeder bleeder_of(const BleederSetting& setting, const sim::Model& model, Faults& faults) {
  const BleederSetting::Hole& hole = setting.holes[size_t(setting.which)];
  sim::Bleeder out;
  out.vessel = model.vessel_index(hole.vessel);
  out.s = hole.at;
  out.area = 0.25 * portable::pi * hole.diameter * hole.diameter;
  out.tick = std::uint64_t(setting.opens / sim::kTick);
  for (const BleederSetting::Hole& h : setting.holes) {
    const int v = model.vessel_index(h.vessel);
    if (v < 0) continue;
    const vessels::FlowSegment& segment = model.vessels.flow.segments[size_t(v)];
    const double lumen = 2 * (segment.radius + segment.taper * h.at);
    if (h.diameter > lumen)
      faults.push_back({h.where, tr("expected a hole at most as wide as '{}' at that point, {:.2g} mm, got {:.2g} mm",
                                    h.vessel, 1e3 * lumen, 1e3 * h.diameter)});
  }
  return out;
}

class Compiling {
 public:
  Compiling(const Description& d, sim::Model& model, Faults& faults)
      : m_description(d), m_model(model), m_faults(faults), m_graph(joined(d)), m_drawn(model) {}

  void compile() {
    gather();
    if (!m_faults.empty()) return;
    build();
    if (!m_faults.empty()) return;
    find_node_carriers();
    for (size_t v = 0; v < m_vessels.size(); ++v) line(v);
  }

 private:
  void gather() {
    double points = 0;
    for (const VesselTree& tree : m_description.vessels)
      for (const Vessel& vessel : tree.vessels) {
        const geometry::NurbsCurve curve = geometry::interpolated(vessel.path);
        const double way = geometry::length(curve), before = points;
        const int count = std::max(3, int(std::min(1e6, way / kVesselSpacing)) + 2);
        points += count;
        if (before <= kMostVesselPoints && points > kMostVesselPoints)
          m_faults.push_back({vessel.at, tr("expected vessels of at most {:g} points, {:g} mm apart, in a "
                                            "scene, got more with '{}'",
                                            kMostVesselPoints, 1e3 * kVesselSpacing, vessel.name)});
        if (points > kMostVesselPoints) return;
        sim::Vessel out;
        out.name = vessel.name;
        out.gain = tree.pulse_gain;
        out.path.length = way;
        for (const Vec3d& p : geometry::sampled_by_arc(curve, count)) out.path.points.emplace_back().drawn = p;
        m_model.vessels.list.push_back(std::move(out));
        m_vessels.push_back(&vessel);
        std::vector<BodyId>& carriers = m_carriers.emplace_back();
        for (const std::string& name : vessel.rides_on)
          if (const BodyId body = body_of(m_model, name); body.exists()) carriers.push_back(body);
      }
  }

  void build() {
    try {
      sim::VesselsModel& all = m_model.vessels;
      all.flow = vessels::build(m_graph);
      const double less = std::max(1.0, double(m_graph.segments.size()) / kFewSegments);
      all.start = vessels::settled_state(all.flow, (kSettle - kAverage) / less);
      vessels::FlowWork work = vessels::make_work(all.flow);
      const int ticks = int(kAverage / less / sim::kTick);
      for (int i = 0; i < ticks; ++i) {
        vessels::advance(all.flow, {}, {}, all.start, work);
        for (size_t v = 0; v < all.list.size(); ++v)
          all.list[v].mean_pressure += read_wall(all.flow, all.start, int(v), 0.5).pressure / ticks;
      }
      for (size_t v = 0; v < all.list.size(); ++v) all.list[v].vein = m_graph.segments[v].vein;
      if (m_description.breathing) all.start.breath = 0;  // scenes begin at the end of an expiration
    } catch (const std::exception& e) {                   // too many cells or anastomoses
      m_faults.push_back({m_description.vessels.front().at,
                          std::string("expected vessels that can be computed together, got: ") + e.what()});
    }
  }

  /// All vessels that meet at a node ride there on the same body, or they would part.
  void find_node_carriers() {
    m_node_carrier.assign(size_t(m_graph.nodes), {});
    std::vector<double> nearest(size_t(m_graph.nodes), 1e30);
    for (size_t v = 0; v < m_vessels.size(); ++v)
      for (const bool to : {false, true}) {
        const size_t node = size_t(to ? m_graph.segments[v].to : m_graph.segments[v].from);
        const std::vector<VesselPoint>& points = m_model.vessels.list[v].path.points;
        const Vec3d p = to ? points.back().drawn : points.front().drawn;
        const Ride ride = nearest_ride(bodies(), m_carriers[v], m_vessels[v]->reach, p);
        if (ride.point.in_space() || ride.distance >= nearest[node]) continue;
        nearest[node] = ride.distance;
        m_node_carrier[node] = ride.point.body;
      }
  }

  void line(size_t v) {
    VesselPath& path = m_model.vessels.list[v].path;
    const vessels::VesselSegment& segment = m_graph.segments[v];
    const double to = segment.radius_to > 0 ? segment.radius_to : segment.radius;
    const size_t n = path.points.size();
    bool carried = false;
    for (size_t i = 0; i < n; ++i) {
      VesselPoint& p = path.points[i];
      p.s = i + 1 == n ? 1 : double(i) / double(n - 1);
      p.radius = kWall * (segment.radius + p.s * (to - segment.radius));
      p.rides = ride_of(v, i, p.drawn);
      carried = carried || !nearest_ride(bodies(), m_carriers[v], m_vessels[v]->reach, p.drawn).point.in_space();
      if (i > 0 && i + 1 < n) {
        p.along = normalised(path.points[i + 1].drawn - path.points[i - 1].drawn);
        p.turn = normalised(p.drawn - path.points[i - 1].drawn) - normalised(path.points[i + 1].drawn - p.drawn);
      }
    }
    const Vessel& vessel = *m_vessels[v];
    if (!vessel.rides_on.empty() && !carried)
      m_faults.push_back(
          {vessel.rides_at.front(), tr("expected some of '{}' within {:g} mm of the bodies that carry it, got none",
                                       vessel.name, 1e3 * vessel.reach)});
    follow_neighbours(path);
  }

  interactions::MaterialPoint ride_of(size_t v, size_t i, Vec3d p) {
    const vessels::VesselSegment& segment = m_graph.segments[v];
    const size_t last = m_model.vessels.list[v].path.points.size() - 1;
    if (i != 0 && i != last) return nearest_ride(bodies(), m_carriers[v], m_vessels[v]->reach, p).point;
    const BodyId on = m_node_carrier[size_t(i == 0 ? segment.from : segment.to)];
    return on.exists() ? ride_on(bodies(), on, p).point : interactions::in_space(p);
  }

  interactions::Bodies bodies() const { return m_drawn.all(); }

  /// Points in space between carried ones go with both; before the first and behind the last ever less.
  static void follow_neighbours(VesselPath& path) {
    const int n = int(path.points.size());
    const double step = path.length / (n - 1);
    const auto carried = [&](int i) { return !path.points[size_t(i)].rides.in_space(); };
    for (int i = 0; i < n; ++i) {
      if (carried(i)) continue;
      VesselPoint& p = path.points[size_t(i)];
      int before = i, after = i;
      while (before >= 0 && !carried(before)) --before;
      while (after < n && !carried(after)) ++after;
      const double behind = step * (i - before), ahead = step * (after - i);
      if (before >= 0 && after < n) {
        p.near[0] = before, p.near[1] = after;
        p.share[0] = ahead / (behind + ahead);
        p.share[1] = behind / (behind + ahead);
      } else if (before >= 0) {
        p.near[0] = before;
        p.share[0] = std::max(0.0, 1 - behind / std::min(kFades, step * (n - 1 - before)));
      } else if (after < n) {
        p.near[0] = after;
        p.share[0] = std::max(0.0, 1 - ahead / std::min(kFades, step * after));
      }
    }
  }

  const Description& m_description;
  sim::Model& m_model;
  Faults& m_faults;
  vessels::VesselGraph m_graph;
  sim::DrawnBodies m_drawn;
  std::vector<const Vessel*> m_vessels;
  std::vector<std::vector<BodyId>> m_carriers;  // (vessels)
  std::vector<BodyId> m_node_carrier;           // (nodes)
};

}  // namespace

void compile_vessels(const Description& d, sim::Model& model, Faults& faults, CompileReport* report) {
  if (d.vessels.empty() || !faults.empty()) return;
  Compiling(d, model, faults).compile();
  if (d.bleeder && faults.empty()) model.vessels.bleeder = bleeder_of(*d.bleeder, model, faults);
  if (!report || !faults.empty()) return;
  BodyReport r;
  r.name = d.vessels.front().name;
  r.kind = "vessels";
  r.nodes = int(model.vessels.flow.cells.size());
  r.springs = int(model.vessels.list.size());
  report->bodies.push_back(r);
}

}  // namespace trocar::scene
