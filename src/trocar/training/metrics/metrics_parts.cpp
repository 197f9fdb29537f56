#include <algorithm>
#include <cmath>

#include <trocar/numerics/filters.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/metrics/metrics_parts.hpp>

namespace trocar::training {
namespace {

constexpr int kFilterOrder = 4;  // each way

template <class T, class Member>
void filter_member(const numerics::LowPass& filter, std::vector<T>& values, Member member,
                   std::vector<double>& scratch) {
  scratch.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) scratch[i] = values[i].*member;
  numerics::filter_zero_phase(filter, scratch);
  for (std::size_t i = 0; i < values.size(); ++i) values[i].*member = scratch[i];
}

std::vector<double> speeds(const std::vector<Vec3d>& place, double rate) {
  const std::size_t n = place.size();
  std::vector<double> speed(n);
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = i + 1 < n ? i + 1 : n - 1;
    speed[i] = length(place[after] - place[before]) * rate / double(after - before);
  }
  return speed;
}

Vec3d shaft_of(Quatd orientation) { return rotate(orientation, Vec3d{0, 0, -1}); }

}  // namespace

Motion filtered_motion(const TraceHand& hand, double rate) {
  Motion m;
  for (const TraceSample& s : hand.samples) {
    m.tip.push_back(s.tip);
    Quatd q = normalised(s.orientation);
    if (!m.orientation.empty() && dot(m.orientation.back(), q) < 0) q = -q;
    m.orientation.push_back(q);
  }
  if (kMotionCutoff < rate / 2) {  // slower sampling has nothing above the cut-off
    const numerics::LowPass filter = numerics::butterworth_low_pass(kFilterOrder, kMotionCutoff, rate);
    std::vector<double> scratch;
    for (const auto member : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) filter_member(filter, m.tip, member, scratch);
    for (const auto member : {&Quatd::w, &Quatd::x, &Quatd::y, &Quatd::z})
      filter_member(filter, m.orientation, member, scratch);
    for (Quatd& q : m.orientation) q = normalised(q);
  }
  m.speed = speeds(m.tip, rate);
  return m;
}

PointMotion filtered_points(std::vector<Vec3d> place, double rate) {
  PointMotion m{std::move(place), {}};
  if (kMotionCutoff < rate / 2) {
    const numerics::LowPass filter = numerics::butterworth_low_pass(kFilterOrder, kMotionCutoff, rate);
    std::vector<double> scratch;
    for (const auto member : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) filter_member(filter, m.place, member, scratch);
  }
  m.speed = speeds(m.place, rate);
  return m;
}

double path_length(std::span<const Vec3d> tip) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < tip.size(); ++i) sum += length(tip[i + 1] - tip[i]);
  return sum;
}

double angular_path(std::span<const Quatd> orientation) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < orientation.size(); ++i) {
    const Quatd turn = conjugate(orientation[i]) * orientation[i + 1];
    sum += 2 * portable::atan2(length(turn.vector()), std::fabs(turn.w));
  }
  return sum;
}

std::vector<double> axial_coordinate(std::span<const Vec3d> tip, std::span<const Quatd> orientation) {
  std::vector<double> axial(tip.size());
  for (std::size_t i = 0; i + 1 < tip.size(); ++i) {
    const Vec3d along = normalised(shaft_of(orientation[i]) + shaft_of(orientation[i + 1]), Vec3d{});
    axial[i + 1] = axial[i] + dot(tip[i + 1] - tip[i], along);
  }
  return axial;
}

double depth_travel(std::span<const double> axial) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < axial.size(); ++i) sum += std::fabs(axial[i + 1] - axial[i]);
  return sum;
}

std::vector<std::size_t> reversals(std::span<const double> axial, double least) {
  std::vector<std::size_t> turns;
  int direction = 0;
  std::size_t lowest = 0, highest = 0;  // since the last turn
  for (std::size_t i = 1; i < axial.size(); ++i) {
    if (axial[i] > axial[highest]) highest = i;
    if (axial[i] < axial[lowest]) lowest = i;
    const bool fell = axial[highest] - axial[i] > least, rose = axial[i] - axial[lowest] > least;
    if (direction >= 0 && fell) {
      if (direction > 0) turns.push_back(highest);
      direction = -1;
      lowest = i;
    } else if (direction <= 0 && rose) {
      if (direction < 0) turns.push_back(lowest);
      direction = 1;
      highest = i;
    }
  }
  return turns;
}

double mean_jerk(std::span<const Vec3d> tip, double rate) {
  const double path = path_length(tip);
  if (tip.size() < 4 || !(path > 0)) return kNoMetric;
  double sum = 0;
  for (std::size_t i = 0; i + 3 < tip.size(); ++i) {
    const Vec3d jerk = rate * rate * rate * (tip[i + 3] - 3.0 * tip[i + 2] + 3.0 * tip[i + 1] - tip[i]);
    sum += dot(jerk, jerk);
  }
  const double duration = double(tip.size() - 1) / rate, squared = duration * duration;
  return std::sqrt(0.5 * squared * squared * duration / (path * path) * (sum / rate));
}

std::vector<char> idle_samples(std::span<const std::span<const double>> speeds, double rate) {
  const std::size_t n = speeds.empty() ? 0 : speeds.front().size();
  std::vector<char> idle(n, 0);
  std::size_t run = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    bool slow = i < n;
    for (const std::span<const double> speed : speeds) slow = slow && speed[i] < kIdleSpeed;
    if (slow) {
      ++run;
      continue;
    }
    if (double(run) >= kIdleTime * rate)
      std::fill(idle.begin() + std::ptrdiff_t(i - run), idle.begin() + std::ptrdiff_t(i), 1);
    run = 0;
  }
  return idle;
}

double pearson(std::span<const double> a, std::span<const double> b) {
  const auto n = double(a.size());
  double mean_a = 0, mean_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a[i] - mean_a, y = b[i] - mean_b;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  // What varies by less than its mean's rounding does not vary.
  const auto varies = [n](double squares, double mean) { return squares > 1e-24 * n * mean * mean; };
  return varies(aa, mean_a) && varies(bb, mean_b) ? ab / (std::sqrt(aa) * std::sqrt(bb)) : kNoMetric;
}

ForceMetrics force_metrics(std::span<const Vec3d> force, double rate, double limit) {
  ForceMetrics m;
  const auto n = double(force.size());
  if (force.empty()) return {kNoMetric, kNoMetric, kNoMetric, kNoMetric, kNoMetric, kNoMetric};
  double squares = 0, sum_nonzero = 0, nonzero = 0;
  Vec3d mean;
  for (const Vec3d& f : force) {
    const double size = length(f);
    m.max = std::max(m.max, size);
    squares += size * size;
    m.impulse += size / rate;
    if (size > limit) m.above += 1 / rate;
    mean += f / n;
    if (size < kLeastForce) continue;
    sum_nonzero += size;
    ++nonzero;
  }
  m.mean_nonzero = nonzero > 0 ? sum_nonzero / nonzero : 0;
  m.rms = std::sqrt(squares / n);
  Mat3d c;  // covariance; the product of the principal standard deviations is the root of its determinant
  for (const Vec3d& f : force) {
    const Vec3d d = f - mean;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) c.m[i][j] += d[i] * d[j] / n;
  }
  const double determinant = dot(c.column(0), cross(c.column(1), c.column(2)));
  m.volume = 4.0 / 3.0 * portable::pi * 27 * std::sqrt(std::max(determinant, 0.0));
  return m;
}

}  // namespace trocar::training
