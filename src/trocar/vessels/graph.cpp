#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/connected.hpp>
#include <trocar/vessels/graph.hpp>

namespace trocar::vessels {
namespace {

using Part = GraphFault::Part;
constexpr std::size_t kMaxFaults = 100;

/// Collects faults, and counts those beyond the hundredth.
struct Faults {
  std::vector<GraphFault> told;
  std::size_t untold = 0;

  void add(Part part, int index, const char* field, std::string message) {
    if (told.size() < kMaxFaults)
      told.push_back({part, index, field, std::move(message)});
    else
      ++untold;
  }
  /// low <= value <= high (low < value where `open`); false for NaN.
  void range(Part part, int index, const char* field, double value, double low, double high, const char* unit,
             bool open = false) {
    if (value <= high && (open ? value > low : value >= low)) return;
    add(part, index, field,
        tr("expected {} {} and at most {} {}, got {}", open ? "more than" : "at least", low, high, unit, value));
  }
  void node(Part part, int index, const char* field, int value, int nodes) {
    if (value < 0 || value >= nodes) add(part, index, field, tr("expected a node, 0 to {}, got {}", nodes - 1, value));
  }
};

bool there(int node, const VesselGraph& graph) { return node >= 0 && node < graph.nodes; }

void check_wall(const VesselSegment& s, int i, Faults& faults) {
  if (s.wall.wave_speed != 0) {
    faults.range(Part::segment, i, "wall.wave_speed", s.wall.wave_speed, 0.1, 1e5, "m/s");
    return;
  }
  faults.range(Part::segment, i, "wall.modulus", s.wall.modulus, 0, 1e16, "Pa", true);
  faults.range(Part::segment, i, "wall.thickness", s.wall.thickness, 0, 0.05, "m", true);
  faults.range(Part::segment, i, "wall.poisson", s.wall.poisson, 0, 0.5, "");
}

void check_segments(const VesselGraph& graph, Faults& faults) {
  for (int i = 0; i < int(graph.segments.size()); ++i) {
    const VesselSegment& s = graph.segments[i];
    faults.node(Part::segment, i, "from", s.from, graph.nodes);
    faults.node(Part::segment, i, "to", s.to, graph.nodes);
    if (s.from == s.to && there(s.from, graph))
      faults.add(Part::segment, i, "to", tr("expected another node than it comes from, got {} again", s.to));
    faults.range(Part::segment, i, "length", s.length, 1e-5, 5, "m");
    faults.range(Part::segment, i, "radius", s.radius, 1e-6, 0.05, "m");
    if (s.radius_to != 0) faults.range(Part::segment, i, "radius_to", s.radius_to, 1e-6, 0.05, "m");
    faults.range(Part::segment, i, "reference_pressure", s.reference_pressure, -1e5, 1e6, "Pa");
    faults.range(Part::segment, i, "loss", s.loss, 0, 1e4, "");
    check_wall(s, i, faults);
  }
}

void check_ends(const VesselGraph& graph, Faults& faults) {
  for (int i = 0; i < int(graph.ends.size()); ++i) {
    const VesselEnd& e = graph.ends[i];
    faults.node(Part::end, i, "node", e.node, graph.nodes);
    faults.range(Part::end, i, "r_near", e.r_near, 0, 1e18, "Pa s/m^3");
    faults.range(Part::end, i, "r_far", e.r_far, 0, 1e18, "Pa s/m^3");
    if (!(e.r_near + e.r_far >= 1e3))
      faults.add(Part::end, i, "r_near",
                 tr("expected r_near + r_far of at least 1000 Pa s/m^3, got {}", e.r_near + e.r_far));
    faults.range(Part::end, i, "compliance", e.compliance, 0, 1, "m^3/Pa");
    faults.range(Part::end, i, "pressure", e.pressure, -1e5, 1e6, "Pa");
  }
}

void check_sources(const VesselGraph& graph, Faults& faults) {
  if (graph.sources.empty()) faults.add(Part::graph, -1, "sources", "expected at least one source, got none");
  for (int i = 0; i < int(graph.sources.size()); ++i) {
    const VesselSource& s = graph.sources[i];
    faults.node(Part::source, i, "node", s.node, graph.nodes);
    faults.range(Part::source, i, "resistance", s.resistance, 0, 1e18, "Pa s/m^3");
    faults.range(Part::source, i, "pressure", s.pressure, -1e5, 1e6, "Pa");
    if (s.kind != VesselSource::Kind::pump) continue;
    if (s.wave.size() < 2 || s.wave.size() > 100'000)
      faults.add(Part::source, i, "wave", tr("expected 2 to 100000 figures, got {}", s.wave.size()));
    for (const double q : s.wave)
      if (!(q >= -1 && q <= 1)) {
        faults.add(Part::source, i, "wave", tr("expected flows within 1 m^3/s, got {}", q));
        break;
      }
  }
}

void check_heart(const Heart& h, Faults& faults) {
  faults.range(Part::heart, -1, "rate", h.rate, 10, 300, "1/min");
  faults.range(Part::heart, -1, "systolic", h.systolic, 0, 1e5, "Pa", true);
  faults.range(Part::heart, -1, "diastolic", h.diastolic, 0, h.systolic > 0 ? h.systolic : 1e5, "Pa");
  faults.range(Part::heart, -1, "breaths", h.breaths, 0, 100, "1/min");
  faults.range(Part::heart, -1, "arterial_swing", h.arterial_swing, 0, 1e4, "Pa");
  faults.range(Part::heart, -1, "venous_swing", h.venous_swing, 0, 1e4, "Pa");
  if (h.shape.size() == 1 || h.shape.size() > 100'000)
    faults.add(Part::heart, -1, "shape", tr("expected none or 2 to 100000 figures, got {}", h.shape.size()));
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double w : h.shape) {
    if (!(w >= -1e9 && w <= 1e9)) {
      faults.add(Part::heart, -1, "shape", tr("expected figures within 1e9, got {}", w));
      return;
    }
    low = w < low ? w : low, high = w > high ? w : high;
  }
  if (!h.shape.empty() && !(high > low))
    faults.add(Part::heart, -1, "shape", "expected a shape that rises, got a line");
  for (std::size_t i = 0; i < h.response.size(); ++i) {
    const LossResponse& r = h.response[i];
    if (!(r.mean >= 0 && r.mean <= 2 && r.pulse >= 0 && r.pulse <= 2 && r.rate > 0 && r.rate <= 4 && r.loss >= 0) ||
        (i > 0 && !(r.loss > h.response[i - 1].loss && r.loss < 1)))
      faults.add(Part::heart, int(i), "response", "expected rising losses and factors of 0 to 2 (rate: up to 4)");
  }
}

void check_settings(const VesselGraph& graph, Faults& faults) {
  const Blood& b = graph.blood;
  faults.range(Part::blood, -1, "density", b.density, 100, 1e4, "kg/m^3");
  faults.range(Part::blood, -1, "viscosity", b.viscosity, 0, 10, "Pa s");
  faults.range(Part::blood, -1, "profile", b.profile, 0, 1000, "");
  faults.range(Part::blood, -1, "volume", b.volume, 1e-5, 0.1, "m^3");
  const FlowSettings& s = graph.settings;
  faults.range(Part::settings, -1, "tick", s.tick, 1e-7, 0.1, "s");
  faults.range(Part::settings, -1, "implicitness", s.implicitness, 0.5, 1, "");
  faults.range(Part::settings, -1, "cell_travel", s.cell_travel, 1e-3, 1e3, "");
  faults.range(Part::settings, -1, "closing_cover", s.closing_cover, 0.5, 1, "");
  faults.range(Part::settings, -1, "discharge", s.discharge, 0.05, 1, "");
  faults.range(Part::settings, -1, "drain_time", s.drain_time, 0, 100, "s");
  faults.range(Part::settings, -1, "ooze_speed", s.ooze_speed, 0, 1, "m/s");
  faults.range(Part::settings, -1, "clot_area", s.clot_area, 0, 1, "m^2");
  faults.range(Part::settings, -1, "clot_time_small", s.clot_time_small, 1, 1e6, "s");
  faults.range(Part::settings, -1, "clot_time_large", s.clot_time_large, 1, 1e6, "s");
  faults.range(Part::settings, -1, "cavity_pressure", s.cavity_pressure, -1e5, 1e5, "Pa");
  faults.range(Part::settings, -1, "max_openings", s.max_openings, 0, 10'000, "");
  faults.range(Part::settings, -1, "max_clips", s.max_clips, 0, 10'000, "");
}

/// Which nodes hang together (union-find with halving).
struct Sets {
  std::vector<int> parent;
  explicit Sets(int n) : parent(std::size_t(n)) { std::iota(parent.begin(), parent.end(), 0); }
  int root(int i) { return vessels::root(parent, i); }
  bool join(int a, int b) {
    a = root(a), b = root(b);
    if (a == b) return false;
    parent[a > b ? a : b] = a > b ? b : a;
    return true;
  }
};

void check_connections(const VesselGraph& graph, Faults& faults) {
  Sets sets(graph.nodes);
  for (int i = 0; i < int(graph.segments.size()); ++i) {
    const VesselSegment& s = graph.segments[i];
    if (!there(s.from, graph) || !there(s.to, graph) || s.from == s.to) continue;
    if (!sets.join(s.from, s.to) && graph.tree)
      faults.add(Part::segment, i, "to", tr("expected a tree, but this closes a cycle at node {}", s.to));
  }
  std::vector<char> met(std::size_t(graph.nodes), 0);
  for (const VesselSegment& s : graph.segments)
    for (const int node : {s.from, s.to})
      if (there(node, graph)) met[node] = 1;
  for (int i = 0; i < graph.nodes; ++i)
    if (!met[i]) faults.add(Part::graph, i, "nodes", tr("expected every node in a segment, {} is in none", i));
  std::vector<char> fed(std::size_t(graph.nodes), 0);
  for (const VesselSource& s : graph.sources)
    if (there(s.node, graph)) fed[sets.root(s.node)] = 1;
  for (int i = 0; i < int(graph.segments.size()); ++i) {
    const VesselSegment& s = graph.segments[i];
    if (!there(s.from, graph) || !there(s.to, graph) || fed[sets.root(s.from)]) continue;
    fed[sets.root(s.from)] = 1;  // once for each part
    faults.add(Part::segment, i, "from", tr("expected a way to a source, node {} has none", s.from));
  }
}

double middle_radius(const VesselSegment& s) { return s.radius_to > 0 ? (s.radius + s.radius_to) / 2 : s.radius; }

}  // namespace

std::vector<GraphFault> check(const VesselGraph& graph) {
  Faults faults;
  if (graph.segments.size() > kMaxSegments || graph.nodes > int(kMaxSegments) + 1) {
    faults.add(Part::graph, -1, "segments",
               tr("expected at most {} segments and {} nodes, got {} and {}", kMaxSegments, kMaxSegments + 1,
                  graph.segments.size(), graph.nodes));
    return faults.told;  // nobody reads on through a million of them
  }
  if (graph.nodes < 2) faults.add(Part::graph, -1, "nodes", tr("expected at least 2, got {}", graph.nodes));
  if (graph.segments.empty()) faults.add(Part::graph, -1, "segments", "expected at least one, got none");
  check_segments(graph, faults);
  check_ends(graph, faults);
  check_sources(graph, faults);
  check_heart(graph.heart, faults);
  check_settings(graph, faults);
  if (graph.nodes >= 2) check_connections(graph, faults);
  if (faults.untold) faults.told.push_back({Part::graph, -1, "", tr("and {} more faults", faults.untold)});
  return faults.told;
}

double wall_stiffness(const VesselSegment& s, const Blood& blood) {
  const VesselWall& w = s.wall;
  if (w.wave_speed > 0) return 2 * blood.density * w.wave_speed * w.wave_speed;
  return w.modulus * w.thickness / (middle_radius(s) * (1 - w.poisson * w.poisson));
}

double wave_speed(const VesselSegment& s, const Blood& blood) {
  return std::sqrt(wall_stiffness(s, blood) / (2 * blood.density));
}

double flow_resistance(const VesselSegment& s, const Blood& blood) {
  const double a = s.radius, b = s.radius_to > 0 ? s.radius_to : s.radius;
  const double inverse4 = (1 / (a * a * a * b) + 1 / (a * a * b * b) + 1 / (a * b * b * b)) / 3;  // mean of 1 / r^4
  return 2 * (blood.profile + 2) * blood.viscosity * s.length * inverse4 / portable::pi;
}

VesselEnd matched_end(const VesselGraph& graph, int segment, double pressure, double flow, double time) {
  const VesselSegment& s = graph.segments[segment];
  const double r = s.radius_to > 0 ? s.radius_to : s.radius;
  VesselEnd end{.node = s.to};
  end.r_near = graph.blood.density * wave_speed(s, graph.blood) / (portable::pi * r * r);
  const double rest = (pressure - end.pressure) / flow - end.r_near;
  end.r_far = rest > 0 ? rest : 0;
  end.compliance = end.r_far > 0 ? time / end.r_far : 0;
  return end;
}

}  // namespace trocar::vessels
