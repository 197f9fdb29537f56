#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/core/field_hash.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/network/force_wave.hpp>

namespace trocar::tissue {
namespace {

constexpr int kSamples = 256;      ///< of the centre line
constexpr double kTail = 4;        ///< widths beyond which g (3e-4 there) counts as nothing
constexpr double kSteepest = 0.6;  ///< of a pair's line against the centre line's direction (cosine): no caps
constexpr double kRise = 3;        ///< [s] in which forces rise: a scene begins in the drawn shape. Our estimate

/// Where a node lies beside the line.
struct Beside {
  double s = 0, r = 0;  ///< way along it, distance from it [m]
  Vec3d axis, along;    ///< nearest point, direction there
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
    best = {line.arc[i - 1] + w * (line.arc[i] - line.arc[i - 1]), 0, at, normalised(ab, {0, 0, 1})};
  }
  best.r = std::sqrt(least);
  return best;
}

ForceWaveStation at(const std::vector<ForceWaveStation>& stations, double s) {
  const ForceWaveStation &first = stations.front(), &last = stations.back();
  if (s <= first.s) return {s, first.pressure, first.speed};
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const ForceWaveStation &a = stations[i - 1], &b = stations[i];
    if (s > b.s) continue;
    const double w = (s - a.s) / std::max(b.s - a.s, 1e-12);
    return {s, a.pressure + w * (b.pressure - a.pressure), a.speed + w * (b.speed - a.speed)};
  }
  return {s, last.pressure, last.speed};
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

/// A as it is for p = 1: 3 V r / R^2, R^2 = 2 <r^2> over the organ's nodes within a slice.
double area_of(std::size_t i, std::span<const Beside> besides, std::span<const double> volume, double slice) {
  double sum = 0, moment = 0;
  for (std::size_t k = 0; k < besides.size(); ++k) {
    const double share = 1 - std::fabs(besides[k].s - besides[i].s) / slice;
    if (!(share > 0)) continue;
    sum += share * volume[k];
    moment += share * volume[k] * besides[k].r * besides[k].r;
  }
  return moment > 0 ? 3 * volume[i] * besides[i].r * sum / (2 * moment) : 0;
}

/// The node of the other side that lies nearest to straight across; -1: none does.
int opposite(std::span<const Vec3d> rest, int node, const Beside& b) {
  const Vec3d out = rest[std::size_t(node)] - b.axis;
  const Vec3d mirrored = b.axis - out;
  int best = -1;
  double least = 1e30;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double distance = dot(rest[i] - mirrored, rest[i] - mirrored);
    if (distance >= least) continue;
    least = distance;
    best = int(i);
  }
  if (best < 0) return -1;
  const Vec3d chord = rest[std::size_t(best)] - rest[std::size_t(node)];
  const double wide = length(chord);
  const bool across = dot(out, rest[std::size_t(best)] - b.axis) < 0 &&
                      std::fabs(dot(chord, b.along)) < kSteepest * wide && least < wide * wide / 4;
  return across ? best : -1;
}

std::vector<std::int32_t> nodes_of(const std::vector<ForceWavePair>& pairs) {
  std::vector<std::int32_t> nodes;
  for (const ForceWavePair& p : pairs) nodes.push_back(p.a), nodes.push_back(p.b);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

ForceWaveModel build(const ForceWaveDescription& d, std::span<const Vec3d> rest, std::span<const double> volume) {
  if (d.centreline.size() < 2 || d.stations.empty()) throw std::invalid_argument("expected a centre line and stations");
  const geometry::Polyline line(geometry::sampled_by_arc(geometry::interpolated(d.centreline), kSamples));
  std::vector<Beside> besides;
  for (const Vec3d& p : rest) besides.push_back(beside(line, p));
  std::vector<double> area;
  for (std::size_t i = 0; i < rest.size(); ++i) area.push_back(area_of(i, besides, volume, d.width));
  ForceWaveModel m;
  m.period = d.period, m.first = d.first, m.cycle = d.cycle, m.active = d.active;
  double wanted = 0, sum = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const int other = opposite(rest, int(i), besides[i]);
    if (other < 0) continue;
    const std::size_t j = std::size_t(other);
    const ForceWaveStation station = at(d.stations, 0.5 * (besides[i].s + besides[j].s));
    // No more than the lighter of the two bears: a sliver of a cell on the other side is not torn out.
    const double shared = area[i] * area[j] / std::max(area[i] + area[j], 1e-30);
    if (!(station.pressure * shared > 0)) continue;
    m.pairs.push_back(
        {std::int32_t(i), other, station.pressure * shared, delay_to(d.stations, station.s), station.speed / d.width});
    wanted += station.pressure * area[i];
    sum += 2 * station.pressure * shared;
  }
  if (m.pairs.empty()) throw std::invalid_argument("nothing of it lies around the centre line, or no pressure");
  for (ForceWavePair& p : m.pairs) p.force *= wanted / sum;
  m.nodes = nodes_of(m.pairs);
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

void add_wave(const ForceWaveModel& m, const NodeView& nodes, double t, std::span<Vec3d> force) noexcept {
  for (const ForceWavePair& p : m.pairs) {
    const double height = wave_height(m, p, t);
    if (!(height > 0)) continue;
    const Vec3d chord = nodes.position(p.b) - nodes.position(p.a);
    const double wide = length(chord);
    if (!(wide > 1e-9)) continue;
    const Vec3d f = (height * p.force / wide) * chord;
    force[std::size_t(p.a)] += f;
    force[std::size_t(p.b)] -= f;
  }
}

void add_to_hash(core::Hasher& h, const ForceWaveModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
