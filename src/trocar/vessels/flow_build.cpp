// A graph becomes cells, rows and their constants.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/sites.hpp>

namespace trocar::vessels {
namespace {

constexpr std::size_t kMaxEntries = 4'000'000;  // of the elimination: 64 MB of a tick's work
constexpr double kSourceResistance = 1e-6;      // of the wave resistance of what a source feeds, where none is given

double square(double x) { return x * x; }

/// Cells and rows while they still have their drawn numbers: rows 0 .. nodes - 1 are the graph's nodes.
struct Builder {
  const VesselGraph& graph;
  FlowModel m;
  int rows;
  std::vector<std::pair<int, int>> links;
  std::vector<double> give, give2, reference;

  explicit Builder(const VesselGraph& g)
      : graph(g), rows(g.nodes), give(std::size_t(g.nodes), 0), give2(give), reference(give) {}

  void segment(const VesselSegment& s);
  void cell(const FlowSegment& segment, int number, int a, int b);
  void half(int row, const FlowCell& cell, double volume, double pressure);
  void renumber();
  void end(const VesselEnd& e);
  void source(const VesselSource& s);
  void cut_resistances();
  void start_pressures();
};

void Builder::segment(const VesselSegment& s) {
  FlowSegment f;
  f.from = s.from, f.to = s.to;
  f.length = s.length;
  f.radius = s.radius;
  f.taper = s.radius_to > 0 ? s.radius_to - s.radius : 0;
  f.give = 1 / wall_stiffness(s, graph.blood);
  f.rest = 1 - f.give * s.reference_pressure;
  f.reference = s.reference_pressure;
  f.vein = s.vein;
  f.first = int(m.cells.size());
  const double longest = graph.settings.cell_travel * graph.settings.tick * wave_speed(s, graph.blood);
  const double cells = std::ceil(s.length / longest);
  if (!(cells + double(m.cells.size()) <= double(kMaxCells)))
    throw std::length_error("vessels: expected at most " + std::to_string(kMaxCells) +
                            " cells; segments are too many, too long or too soft for the tick");
  f.cells = std::max(1, int(cells));
  int a = s.from;
  for (int i = 0; i < f.cells; ++i) {
    const int b = i + 1 == f.cells ? s.to : rows++;
    cell(f, i, a, b);
    a = b;
  }
  m.segments.push_back(f);
  for (int i = f.first; i < f.first + f.cells; ++i) m.cells[i].loss = s.loss * graph.blood.density / 2 / f.cells;
}

void Builder::cell(const FlowSegment& f, int number, int a, int b) {
  const double dx = f.length / f.cells, dt = graph.settings.tick, rho = graph.blood.density;
  const double ra = f.radius + f.taper * number / f.cells, rb = f.radius + f.taper * (number + 1) / f.cells;
  FlowCell c;
  c.a = a, c.b = b;
  c.rest = f.rest, c.give = f.give;
  c.area_a = portable::pi * ra * ra, c.area_b = portable::pi * rb * rb, c.area = portable::pi * square((ra + rb) / 2);
  c.inertia = rho * dx / (graph.settings.implicitness * dt);
  c.friction = 2 * (graph.blood.profile + 2) * portable::pi * graph.blood.viscosity * dx;
  c.carried = 2 * rho * dx * c.area * c.give / dt;
  c.courant = dt / dx;
  give.resize(std::size_t(rows), 0), give2.resize(std::size_t(rows), 0), reference.resize(std::size_t(rows), 0);
  half(a, c, dx / 2 * (0.75 * c.area_a + 0.25 * c.area_b), f.reference);
  half(b, c, dx / 2 * (0.25 * c.area_a + 0.75 * c.area_b), f.reference);
  m.cells.push_back(c);
  links.emplace_back(a, b);
}

/// A row holds half of each cell that it bounds: volume (rest + give p)^2.
void Builder::half(int row, const FlowCell& c, double volume, double pressure) {
  give[row] += 2 * volume * c.rest * c.give;
  give2[row] += volume * c.give * c.give;
  reference[row] = pressure;
}

void Builder::renumber() {
  m.plan = plan_elimination(rows, links, kMaxEntries);
  const std::size_t n = std::size_t(rows);
  m.give.resize(n), m.give2.resize(n), m.low.resize(n), m.high.resize(n), m.start_pressure.resize(n);
  for (int i = 0; i < rows; ++i) {
    const int row = m.plan.row_of[i];
    m.give[row] = give[i], m.give2[row] = give2[i];
    const double usual = give[i] + 2 * give2[i] * reference[i];
    m.low[row] = (kNarrowest * usual - give[i]) / (2 * give2[i]);
    m.high[row] = (kWidest * usual - give[i]) / (2 * give2[i]);
    m.start_pressure[row] = reference[i];
  }
  for (FlowCell& c : m.cells) c.a = m.plan.row_of[c.a], c.b = m.plan.row_of[c.b];
}

void Builder::end(const VesselEnd& e) {
  const double dt = graph.settings.tick, theta = graph.settings.implicitness;
  FlowEnd f;
  f.row = m.plan.row_of[e.node];
  f.pressure = e.pressure;
  f.conductance = 1 / (e.r_near + e.r_far);
  if (e.compliance > 0 && e.r_far > 0) {
    f.near = 1 / (e.r_near > 0 ? e.r_near : 1e-6 * e.r_far), f.far = 1 / e.r_far;
    f.storage = e.compliance / dt;
    f.inner = 1 / (f.storage + theta * (f.near + f.far));
    f.conductance = f.near - f.near * f.near * theta * f.inner;
  }
  m.ends.push_back(f);
}

void Builder::source(const VesselSource& s) {
  FlowSource f;
  f.node = s.node, f.row = m.plan.row_of[s.node];
  f.kind = s.kind, f.venous = s.venous, f.pressure = s.pressure, f.wave = s.wave;
  double least = std::numeric_limits<double>::infinity();
  for (const VesselSegment& v : graph.segments)
    if (v.from == s.node || v.to == s.node)
      least = std::min(least, graph.blood.density * wave_speed(v, graph.blood) / (portable::pi * v.radius * v.radius));
  f.conductance = 1 / (s.resistance > 0 ? s.resistance : kSourceResistance * std::min(least, 1e15));
  m.sources.push_back(std::move(f));
}

/// Least resistance of a way from any source to each node (Dijkstra).
std::vector<double> resistance_to(const VesselGraph& graph) {
  std::vector<std::vector<std::pair<int, double>>> next(static_cast<std::size_t>(graph.nodes));
  for (const VesselSegment& s : graph.segments) {
    const double r = flow_resistance(s, graph.blood);
    next[s.from].emplace_back(s.to, r), next[s.to].emplace_back(s.from, r);
  }
  std::vector<double> least(std::size_t(graph.nodes), std::numeric_limits<double>::infinity());
  std::set<std::pair<double, int>> queue;
  for (const VesselSource& s : graph.sources) {
    const double r = s.resistance;
    if (r < least[s.node]) least[s.node] = r, queue.emplace(r, s.node);
  }
  while (!queue.empty()) {
    const auto [r, i] = *queue.begin();
    queue.erase(queue.begin());
    if (r > least[i]) continue;
    for (const auto& [j, step] : next[i])
      if (r + step < least[j]) least[j] = r + step, queue.emplace(least[j], j);
  }
  return least;
}

/// Pressure over flow where a segment is cut through at its far end under the mean pressure:
/// rho / 2 (Q / Cd A)^2 + R Q = p.
void Builder::cut_resistances() {
  const std::vector<double> least = resistance_to(graph);
  const double mean = (graph.heart.systolic + 2 * graph.heart.diastolic) / 3;
  const double p = std::max(mean - graph.settings.cavity_pressure, 1000.0);
  for (std::size_t i = 0; i < m.segments.size(); ++i) {
    const FlowSegment& s = m.segments[i];
    const double r = std::min(least[s.from], least[s.to]) + flow_resistance(graph.segments[i], graph.blood);
    const double a = graph.settings.discharge * portable::pi * square(s.radius + s.taper / 2);
    const double orifice = graph.blood.density / (2 * a * a);
    m.segments[i].cut_resistance = (r + std::sqrt(r * r + 4 * orifice * p)) / 2;
  }
}

/// Pressure of what feeds each part, spread over it; pumps leave the segments' reference pressures.
void Builder::start_pressures() {
  std::vector<std::vector<int>> next(static_cast<std::size_t>(rows));
  for (const FlowCell& c : m.cells) next[c.a].push_back(c.b), next[c.b].push_back(c.a);
  std::vector<char> done(std::size_t(rows), 0);
  for (const FlowSource& s : m.sources) {
    if (s.kind == VesselSource::Kind::pump || done[s.row]) continue;
    const double p = s.kind == VesselSource::Kind::heart
                         ? graph.heart.diastolic + m.beat_mean * (graph.heart.systolic - graph.heart.diastolic)
                         : s.pressure;
    std::vector<int> open{s.row};
    done[s.row] = 1;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      m.start_pressure[i] = p;
      for (const int j : next[i])
        if (!done[j]) done[j] = 1, open.push_back(j);
    }
  }
}

std::vector<double> beat_of(const Heart& heart) {
  if (heart.shape.empty()) return textbook_beat(256);
  const auto [low, high] = std::minmax_element(heart.shape.begin(), heart.shape.end());
  std::vector<double> beat;
  for (const double w : heart.shape) beat.push_back((w - *low) / (*high - *low));
  return beat;
}

const char* name_of(GraphFault::Part part) {
  const char* names[] = {"graph", "segment", "end", "source", "heart", "blood", "settings"};
  return names[int(part)];
}

}  // namespace

FlowModel build(const VesselGraph& graph) {
  if (const auto faults = check(graph); !faults.empty()) {
    const GraphFault& f = faults.front();
    throw std::invalid_argument(std::string("vessels: ") + name_of(f.part) +
                                (f.index >= 0 ? " " + std::to_string(f.index) : "") + ", " + f.field + ": " +
                                f.message);
  }
  Builder b(graph);
  b.m.nodes = graph.nodes;
  b.m.heart = graph.heart, b.m.blood = graph.blood, b.m.settings = graph.settings;
  b.m.drain_ticks = int(graph.settings.drain_time / graph.settings.tick + 0.5);
  b.m.beat = beat_of(graph.heart);
  for (const double w : b.m.beat) b.m.beat_mean += w / double(b.m.beat.size());
  for (const VesselSegment& s : graph.segments) b.segment(s);
  b.renumber();
  for (const VesselEnd& e : graph.ends) b.end(e);
  for (const VesselSource& s : graph.sources) b.source(s);
  b.cut_resistances();
  b.start_pressures();
  return std::move(b.m);
}

FlowState rest_state(const FlowModel& m) {
  FlowState s;
  s.p = m.start_pressure;
  s.dp.assign(s.p.size(), 0), s.owed = s.dp;
  s.q.assign(m.cells.size(), 0), s.dq = s.q;
  for (const FlowEnd& e : m.ends) {
    const double near = e.inner > 0 ? e.near : 0, far = e.inner > 0 ? e.far : 1;  // as if it had flowed for long
    s.end_pressure.push_back((near * s.p[e.row] + far * e.pressure) / (near + far));
  }
  s.openings.resize(std::size_t(m.settings.max_openings));
  s.clips.resize(std::size_t(m.settings.max_clips));
  return s;
}

FlowState settled_state(const FlowModel& m, double seconds) {
  FlowState s = rest_state(m);
  FlowWork w = make_work(m);
  for (double t = 0; t < seconds; t += m.settings.tick) advance(m, {}, {}, s, w);
  return s;
}

FlowWork make_work(const FlowModel& m) {
  FlowWork w;
  const std::size_t rows = m.give.size(), cells = m.cells.size();
  w.capacity.resize(rows), w.extra.resize(rows), w.ahead.resize(rows), w.diagonal.resize(rows), w.x.resize(rows);
  w.values.resize(m.plan.values());
  w.flow0.resize(cells), w.flow_a.resize(cells), w.flow_b.resize(cells);
  const std::size_t sites = std::size_t(m.settings.max_openings + m.settings.max_clips);
  w.sites.resize(sites), w.chains.resize(sites), w.points.resize(3 * sites + 1);
  w.part.resize(std::size_t(m.nodes)), w.part_fed.resize(std::size_t(m.nodes));
  w.blocked.resize(m.segments.size());
  return w;
}

}  // namespace trocar::vessels
