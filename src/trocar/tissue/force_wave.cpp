#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/polyline.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/force_wave.hpp>

namespace trocar::tissue {
namespace {

constexpr int kSamples = 256;      ///< of the centre line
constexpr double kTail = 4;        ///< widths beyond which g (3e-4 there) counts as nothing
constexpr double kSteepest = 0.6;  ///< of a pair's line against the centre line's direction (cosine): no caps
constexpr double kRise = 3;        ///< [s] within which forces come up, so that a scene begins as drawn        Ours

/// A place of the wall beside the line.
struct Beside {
  double s = 0;
  Vec3d axis, along;
};

Beside beside(const geometry::Polyline& line, Vec3d p) {
  Beside best;
  double least = 1e30;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    const Vec3d a = line.points[i - 1], ab = line.points[i] - a;
    const double w = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    const Vec3d at = a + w * ab;
    const double distance = dot(p - at, p - at);
    if (distance >= least) continue;
    least = distance;
    best = {line.arc[i - 1] + w * (line.arc[i] - line.arc[i - 1]), at, normalised(ab, {0, 0, 1})};
  }
  return best;
}

std::vector<double> areas(const Skin& skin) {
  std::vector<double> area(std::size_t(skin.size()), 0.0);
  for (const auto& t : skin.triangles) {
    const auto x = [&](std::size_t k) { return vec_cast<double>(skin.rest[std::size_t(t[k])]); };
    const double third = length(cross(x(1) - x(0), x(2) - x(0))) / 6;
    for (const int corner : t) area[std::size_t(corner)] += third;
  }
  return area;
}

ForceWaveStation at(const std::vector<ForceWaveStation>& stations, double s) {
  if (s <= stations.front().s) return stations.front();
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const ForceWaveStation &a = stations[i - 1], &b = stations[i];
    if (s > b.s) continue;
    const double w = (s - a.s) / std::max(b.s - a.s, 1e-12);
    return {s, a.pressure + w * (b.pressure - a.pressure), a.speed + w * (b.speed - a.speed)};
  }
  return stations.back();
}

/// Time over a stretch on which the speed changes evenly.
double stretch_time(double way, double v0, double v1) {
  const double change = v1 - v0;
  if (std::fabs(change) < 1e-6 * v0) return way / v0;
  return way / change * portable::log(v1 / v0);
}

/// Time that a wave takes from s = 0 to s.
double delay_to(const std::vector<ForceWaveStation>& stations, double s) {
  double time = 0, from = 0;
  for (const ForceWaveStation& station : stations) {
    const double to = std::min(std::max(station.s, 0.0), s);
    if (to > from) time += stretch_time(to - from, at(stations, from).speed, at(stations, to).speed);
    from = std::max(from, to);
  }
  return time + (s - from) / stations.back().speed;
}

/// The vertex of the other side that lies nearest to straight across; -1: none does.
int opposite(const Skin& skin, std::span<const Vec3d> points, int vertex, const Beside& b) {
  const Vec3d out = points[std::size_t(vertex)] - b.axis;
  const Vec3d mirrored = b.axis - out;
  int best = -1;
  double least = 1e30;
  for (int i = 0; i < skin.size(); ++i) {
    const double distance = dot(points[std::size_t(i)] - mirrored, points[std::size_t(i)] - mirrored);
    if (distance >= least || !skin.at_surface(i)) continue;
    least = distance;
    best = i;
  }
  if (best < 0) return -1;
  const Vec3d chord = points[std::size_t(best)] - points[std::size_t(vertex)];
  const double wide = length(chord);
  const bool across = dot(out, points[std::size_t(best)] - b.axis) < 0 &&
                      std::fabs(dot(chord, b.along)) < kSteepest * wide && least < wide * wide / 4;
  return across ? best : -1;
}

std::vector<std::int32_t> nodes_of(const std::vector<ForceWavePair>& pairs, const Skin& skin) {
  std::vector<std::int32_t> nodes;
  for (const ForceWavePair& p : pairs)
    for (const std::int32_t v : {p.a, p.b})
      for (const int node : skin.weights[std::size_t(v)].node) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void add_force(const SkinWeights& w, Vec3d f, std::span<Vec3d> force) noexcept {
  for (std::size_t k = 0; k < 8; ++k) force[std::size_t(w.node[k])] += double(w.weight[k]) * f;
}

}  // namespace

ForceWaveModel build(const ForceWaveDescription& d, const Skin& skin) {
  if (d.centreline.size() < 2 || d.stations.empty()) throw std::invalid_argument("expected a centre line and stations");
  const geometry::Polyline line(geometry::sampled_by_arc(geometry::interpolated(d.centreline), kSamples));
  const std::vector<double> area = areas(skin);
  std::vector<Vec3d> points;
  for (const Vec3f& p : skin.rest) points.push_back(vec_cast<double>(p));
  ForceWaveModel m;
  m.period = d.period, m.first = d.first, m.cycle = d.cycle, m.active = d.active;
  for (int i = 0; i < skin.size(); ++i) {
    if (!skin.at_surface(i)) continue;
    const Beside here = beside(line, points[std::size_t(i)]);
    const int other = opposite(skin, points, i, here);
    if (other < 0) continue;
    const double s = 0.5 * (here.s + beside(line, points[std::size_t(other)]).s);
    const ForceWaveStation station = at(d.stations, s);
    // Half of it: a vertex pulls at its opposite, and is as a rule another one's.
    const double force = 0.5 * station.pressure * area[std::size_t(i)];
    if (force > 0) m.pairs.push_back({i, other, force, delay_to(d.stations, s), station.speed / d.width});
  }
  if (m.pairs.empty()) throw std::invalid_argument("no wall of it lies around the centre line, or no pressure");
  m.nodes = nodes_of(m.pairs, skin);
  return m;
}

double wave_height(const ForceWaveModel& m, const ForceWavePair& pair, double t) noexcept {
  const double since = t - m.first - pair.delay, reach = kTail / pair.sharp;
  double sum = 0;
  for (double k = std::ceil((since - reach) / m.period); k <= (since + reach) / m.period; k += 1) {
    const double begun = k * m.period / m.cycle;
    if (begun - std::floor(begun) >= m.active) continue;
    const double d = pair.sharp * (since - k * m.period);
    sum += portable::exp(-0.5 * d * d);
  }
  const double rise = std::min(t / kRise, 1.0);
  return sum * (rise * rise * (3 - 2 * rise));
}

void add_wave(const ForceWaveModel& m, const Skin& skin, std::span<const Vec3f> now, double t,
              std::span<Vec3d> force) noexcept {
  for (const ForceWavePair& p : m.pairs) {
    const double height = wave_height(m, p, t);
    if (!(height > 0)) continue;
    const Vec3d chord = vec_cast<double>(now[std::size_t(p.b)]) - vec_cast<double>(now[std::size_t(p.a)]);
    const double wide = length(chord);
    if (!(wide > 1e-9)) continue;
    const Vec3d f = (height * p.force / wide) * chord;
    add_force(skin.weights[std::size_t(p.a)], f, force);
    add_force(skin.weights[std::size_t(p.b)], -1.0 * f, force);
  }
}

void add_to_hash(core::Hasher& h, const ForceWaveModel& m) noexcept {
  for (const ForceWavePair& p : m.pairs) {
    h.add(p.a), h.add(p.b);
    for (const double v : {p.force, p.delay, p.sharp}) h.add(v);
  }
  h.add(m.nodes);
  for (const double v : {m.period, m.first, m.cycle, m.active}) h.add(v);
}

}  // namespace trocar::tissue
