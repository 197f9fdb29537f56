#include <algorithm>
#include <cmath>

#include <trocar/core/tick.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/infusion/infusion.hpp>

namespace trocar::tissue {
namespace {

constexpr double kOnePicolitre = 1e-15;  // [m^3]
constexpr double kReach = 3;             // of sigma: beyond it a Gaussian is nothing
constexpr double kFollows = 0.1;         // [s] tau.                                           Our choice
constexpr float kMostPerTheta = 4;       // times E theta: no pressure that so little fluid could not account for
constexpr double kLookedFor = 0.02;      // [m] how far the pressure of a place is looked for
constexpr float kNoPressure = 1;         // [Pa] less is none where it has torn
constexpr float kRelieves = 0.98f;       // per tick, of a pressure at a cell that has torn.   Our choice

/// Six times the volume of a cell, and its derivatives with the corners.
struct CellShape {
  Vec3f a, b, c;  ///< from corner 0
  float six;
  CellShape(const std::vector<NodeState>& rows, const TetRest& cell) noexcept
      : a(from(rows, cell, 1)), b(from(rows, cell, 2)), c(from(rows, cell, 3)), six(dot(a, cross(b, c))) {}

 private:
  static Vec3f from(const std::vector<NodeState>& rows, const TetRest& cell, int k) noexcept {
    const NodeState &o = rows[std::size_t(cell.row[0])], &n = rows[std::size_t(cell.row[k])];
    return {n.x - o.x, n.y - o.y, n.z - o.z};
  }
};

/// A bell about `place`, of nodes in reach; f(row, value).
template <class F>
void for_bell(const InfusionModel& m, const NodeView& nodes, Vec3d place, double sigma, F&& f) noexcept {
  const double most2 = kReach * kReach * sigma * sigma, per = 1 / (2 * sigma * sigma);
  for (std::size_t r = 0; r < m.room.size(); ++r) {
    if (!(m.room[r] > 0)) continue;
    const NodeState& n = nodes.rows[r];
    const Vec3d off = Vec3d{double(n.x), double(n.y), double(n.z)} + nodes.origin - place;
    const double far2 = dot(off, off);
    if (far2 < most2) f(r, portable::exp(-far2 * per));
  }
}

/// Shares `amount` out by weights, in whole picolitres; give(row, part) takes a part. What rounding leaves goes to the
/// heaviest.
template <class Give>
void share_out(std::span<const double> weight, double sum, std::int64_t amount, Give&& give) noexcept {
  std::int64_t left = amount;
  std::size_t heaviest = 0;
  for (std::size_t r = 0; r < weight.size(); ++r) {
    if (!(weight[r] > 0)) continue;
    if (weight[r] > weight[heaviest]) heaviest = r;
    const auto part = std::min(left, std::int64_t(double(amount) * (weight[r] / sum)));
    give(r, part);
    left -= part;
  }
  give(heaviest, left);
}

}  // namespace

InfusionModel infusion_of(const NetworkModel& network, double youngs_modulus) {
  InfusionModel m;
  m.modulus = youngs_modulus;
  m.opening = 5.0 / 6 * youngs_modulus;
  m.room.assign(std::size_t(network.rows), 0);
  double sum = 0;
  for (const TetRest& cell : network.tets)
    for (const int row : cell.row) {
      m.room[std::size_t(row)] += cell.rest6 / 24;
      sum += double(cell.rest6) / 24;
    }
  m.finest = sum > 0 ? portable::exp(portable::log(sum / network.nodes) / 3) : 0;
  return m;
}

InfusionState dry(const InfusionModel& m) {
  InfusionState s;
  s.volume.assign(m.room.size(), 0);
  s.pressure.assign(m.room.size(), 0);
  s.dose.assign(m.room.size(), 0);
  s.since.assign(m.room.size(), 0);
  return s;
}

InfusionWork make_work(const InfusionModel& m) {
  InfusionWork w;
  w.weight.resize(m.room.size());
  w.now.resize(m.room.size());
  w.force.resize(m.room.size());
  w.torn.resize(m.room.size());
  return w;
}

double spread_of(double volume) noexcept {
  if (!(volume > 0)) return kNarrowest;
  // volume = kMeant (2 pi)^1.5 sigma^3
  const double cube = volume / (kMeant * portable::two_pi * std::sqrt(portable::two_pi));
  return std::max(kNarrowest, portable::exp(portable::log(cube) / 3));
}

std::int64_t infuse(const InfusionModel& m, const NodeView& nodes, Vec3d tip, std::int64_t amount, double sigma,
                    bool drugged, std::uint32_t tick, InfusionState& s, InfusionWork& w) noexcept {
  if (amount <= 0) return 0;
  std::fill(w.weight.begin(), w.weight.end(), 0.0);
  double sum = 0, space = 0;  // space: what they could take at most [pL]
  for_bell(m, nodes, tip, std::max(sigma, m.finest), [&](std::size_t r, double bell) {
    const double full = kFullest * double(m.room[r]) / kOnePicolitre, left = full - double(s.volume[r]);
    if (left <= 0) return;
    w.weight[r] = bell * left;
    sum += w.weight[r];
    space += left;
  });
  if (!(sum > 0)) return 0;
  const std::int64_t goes = std::min(amount, std::int64_t(space));
  share_out(w.weight, sum, goes, [&](std::size_t r, std::int64_t part) {
    s.volume[r] += part;
    if (!drugged) return;
    s.dose[r] += float(double(part) * kOnePicolitre / double(m.room[r]));
    if (s.since[r] == 0 && s.dose[r] >= kDoseFelt) s.since[r] = tick;
  });
  s.total += goes;
  s.stirred = 1;
  return goes;
}

double filled_about(const InfusionModel& m, const NodeView& nodes, Vec3d place, double sigma,
                    const InfusionState& s) noexcept {
  double taken = 0, full = 0;
  for_bell(m, nodes, place, std::max(sigma, m.finest), [&](std::size_t r, double bell) {
    taken += bell * double(s.volume[r]) * kOnePicolitre;
    full += bell * kFullest * double(m.room[r]);
  });
  return full > 0 ? std::min(1.0, taken / full) : 1.0;
}

std::int64_t let_out(const InfusionModel& m, const NodeView& nodes, Vec3d place, std::int64_t amount, double sigma,
                     InfusionState& s, InfusionWork& w) noexcept {
  if (amount <= 0 || s.total == 0) return 0;
  std::fill(w.weight.begin(), w.weight.end(), 0.0);
  double sum = 0;
  std::int64_t there = 0;
  for_bell(m, nodes, place, std::max(sigma, m.finest), [&](std::size_t r, double bell) {
    if (s.volume[r] <= 0) return;
    w.weight[r] = bell * double(s.volume[r]);
    sum += w.weight[r];
    there += s.volume[r];
  });
  if (!(sum > 0)) return 0;
  std::int64_t out = 0;
  share_out(w.weight, sum, std::min(amount, there), [&](std::size_t r, std::int64_t part) {
    const std::int64_t taken = std::min(part, s.volume[r]);
    s.volume[r] -= taken;
    out += taken;
  });
  s.total -= out;
  return out;
}

std::int64_t absorb(double share, InfusionState& s) noexcept {
  if (s.total == 0) return 0;
  std::int64_t out = 0;
  for (std::int64_t& v : s.volume) {
    if (v == 0) continue;
    const std::int64_t goes = std::max(std::int64_t(1), std::int64_t(double(v) * share));
    v -= goes;
    out += goes;
  }
  s.total -= out;
  return out;
}

std::int64_t drain_tears(double share, const InfusionWork& w, InfusionState& s, std::int32_t& most) noexcept {
  std::int64_t out = 0, largest = 0;
  most = -1;
  for (std::size_t r = 0; r < s.volume.size(); ++r) {
    std::int64_t& v = s.volume[r];
    if (v == 0 || w.torn[r] == 0) continue;
    if (v > largest) largest = v, most = std::int32_t(r);
    const std::int64_t goes = std::max(std::int64_t(1), std::int64_t(double(v) * share));
    v -= goes;
    out += goes;
  }
  s.total -= out;
  return out;
}

namespace {

/// g of a cell that is stretched beyond what its fluid accounts for.                                     [torn cell]
float relieved(float six, float rest6) noexcept {
  const float whole = (1 + float(kFullest)) * rest6, burst = kBursts * rest6;
  return six > whole ? std::max(0.0f, (burst - six) / (burst - whole)) : 1.0f;
}

/// Marks rows at cells that have torn.
void find_tears(const NetworkModel& network, std::span<const std::uint8_t> phase, const InfusionState& s,
                InfusionWork& w) noexcept {
  w.tears = 0;
  std::fill(w.torn.begin(), w.torn.end(), std::uint8_t(0));
  for (std::size_t t = 0; t < phase.size(); ++t) {
    if (phase[t] != kGone) continue;
    for (const int row : network.tets[t].row) {
      w.torn[std::size_t(row)] = 1;
      if (s.volume[std::size_t(row)] > 0) w.tears = 1;
    }
  }
}

}  // namespace

void swell(const InfusionModel& m, const NetworkModel& network, const std::vector<NodeState>& rows, double dt,
           InfusionState& s, InfusionWork& w, std::span<const std::uint8_t> phase) noexcept {
  w.pushes = w.tears = 0;
  if (!s.stirred) return;
  find_tears(network, phase, s, w);
  const std::size_t n = m.room.size();
  std::fill(w.now.begin(), w.now.end(), 0.0f);
  std::fill(w.force.begin(), w.force.end(), Vec3f{0, 0, 0});
  for (std::size_t r = 0; r < n; ++r) w.weight[r] = s.volume[r] > 0 || s.pressure[r] > 0 ? 1 : 0;
  for (std::size_t t = 0; t < network.tets.size(); ++t) {
    const TetRest& cell = network.tets[t];
    double active = 0;
    for (const int row : cell.row) active += w.weight[std::size_t(row)];
    if (active == 0) continue;
    if (t < phase.size() && phase[t] == kGone) {  // counts as it was drawn, and holds nothing
      for (const int row : cell.row) w.now[std::size_t(row)] += cell.rest6 / 24;
      continue;
    }
    const CellShape shape(rows, cell);
    float p = 0;
    for (const int row : cell.row) {
      w.now[std::size_t(row)] += shape.six / 24;
      p += 0.25f * s.pressure[std::size_t(row)];
    }
    if (p == 0 || shape.six <= 0.1f * cell.rest6) continue;  // one that has collapsed is the guard's
    p *= relieved(shape.six, cell.rest6);
    const Vec3f fa = (p / 6) * cross(shape.b, shape.c), fb = (p / 6) * cross(shape.c, shape.a),
                fc = (p / 6) * cross(shape.a, shape.b);
    w.force[std::size_t(cell.row[0])] -= fa + fb + fc;
    w.force[std::size_t(cell.row[1])] += fa;
    w.force[std::size_t(cell.row[2])] += fb;
    w.force[std::size_t(cell.row[3])] += fc;
  }
  const float gain = float(m.modulus * dt / kFollows);
  bool any = false;
  for (std::size_t r = 0; r < n; ++r) {
    if (w.weight[r] == 0) continue;
    const float theta = float(double(s.volume[r]) * kOnePicolitre / double(m.room[r]));
    const float stands = w.now[r] / m.room[r] - 1;
    const float before = s.pressure[r];
    const float most = std::min(float(m.opening), kMostPerTheta * float(m.modulus) * theta);
    s.pressure[r] = std::clamp(s.pressure[r] + gain * (theta - stands), 0.0f, most);
    if (w.torn[r] != 0) s.pressure[r] = before > kNoPressure ? kRelieves * before : 0;
    any = any || s.pressure[r] > 0 || s.volume[r] > 0;
  }
  s.stirred = any ? 1 : 0;
  w.pushes = 1;
}

double pressure_at(const NodeView& nodes, Vec3d place, const InfusionState& s) noexcept {
  if (s.total == 0) return 0;
  double least2 = kLookedFor * kLookedFor;
  float p = 0;
  for (std::size_t r = 0; r < s.volume.size(); ++r) {
    if (s.volume[r] == 0) continue;
    const NodeState& n = nodes.rows[r];
    const Vec3d off = Vec3d{double(n.x), double(n.y), double(n.z)} + nodes.origin - place;
    const double far2 = dot(off, off);
    if (far2 >= least2) continue;
    least2 = far2;
    p = s.pressure[r];
  }
  return double(p);
}

namespace {
double eased(double x) noexcept {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
}  // namespace

double blanched(float dose, double age) noexcept {
  if (!(dose > kDoseFelt) || age <= kBlanchOnset) return 0;
  const double strength = eased(double((dose - kDoseFelt) / (kDoseFull - kDoseFelt)));
  const double come = eased((age - kBlanchOnset) / (kBlanchFull - kBlanchOnset));
  return strength * come * (1 - eased((age - kBlanchLasts) / kBlanchFades));
}

double blanched(const InfusionState& s, std::size_t row, std::uint64_t tick) noexcept {
  if (s.since[row] == 0) return 0;
  return blanched(s.dose[row], double(tick - s.since[row]) * core::kTick);
}

}  // namespace trocar::tissue
