#include <algorithm>
#include <cmath>

#include <trocar/training/metrics/metrics_parts.hpp>
#include <trocar/training/metrics/smoothness.hpp>

namespace trocar::training {
namespace {

/// Samples that count: from the first motion of any hand to the end.
struct Window {
  std::size_t first = 0, count = 0;
  template <class T>
  std::span<const T> of(const std::vector<T>& all) const {
    return std::span<const T>(all).subspan(first, count);
  }
};

/// @param speeds  of everything that moves
Window window_of(const Trace& trace, const std::vector<std::span<const double>>& speeds, double end) {
  std::size_t last = trace.size();  // one past it
  if (end < trace.time(last - 1)) {
    const double index = std::floor((end - trace.start) * trace.rate + 1e-6);
    last = index >= 0 ? std::size_t(index) + 1 : 0;
  }
  for (std::size_t i = 0; i < last; ++i)
    for (const std::span<const double> speed : speeds)
      if (speed[i] > kMovingSpeed) return {i, last - i};
  return {};
}

/// The value that 95 % of them do not exceed, by nearest rank.
double percentile_95(std::vector<double> values) {
  if (values.empty()) return kNoMetric;
  std::sort(values.begin(), values.end());
  return values[(95 * values.size() + 99) / 100 - 1];
}

/// Of the endoscope, within the window.
CameraMetrics camera_metrics(const Trace& trace, const PointMotion& lens, const Window& window,
                             const CameraWatch& watch) {
  CameraMetrics m;
  m.on_target = watch.on_target;
  m.lens_touches = watch.lens_touches;
  double sum = 0;
  for (const double seconds : watch.target_seconds) sum += seconds;
  if (!watch.target_seconds.empty()) {
    m.target_mean = sum / double(watch.target_seconds.size());
    m.target_longest = *std::max_element(watch.target_seconds.begin(), watch.target_seconds.end());
  }
  if (trace.scope.empty()) return m;
  m.path = path_length(window.of(lens.place));
  std::vector<double> tilts;
  double total = 0;
  for (const TraceScope& s : window.of(trace.scope)) {
    if (s.horizon == TraceScope::kNoHorizon) continue;
    tilts.push_back(std::fabs(s.horizon));
    total += tilts.back();
  }
  if (!tilts.empty()) m.horizon_mean = total / double(tilts.size());
  m.horizon_p95 = percentile_95(std::move(tilts));
  return m;
}

/// Of one hand: window start, marks in the window, window end.
std::vector<Vec3d> own_waypoints(const Trace& trace, int hand, const Motion& motion, const Window& window) {
  std::vector<Vec3d> points{motion.tip[window.first]};
  const std::size_t last = window.first + window.count - 1;
  for (const TraceMark& mark : trace.marks)
    if (mark.hand == hand && mark.sample > window.first && mark.sample < last)
      points.push_back(motion.tip[mark.sample]);
  if (points.size() > 1) points.push_back(motion.tip[last]);
  return points;
}

template <class T>
bool given(const std::vector<std::vector<T>>& lists, std::size_t hand) {
  return hand < lists.size() && !lists[hand].empty();
}

bool near_any(Vec3d place, const std::vector<Vec3d>& targets) {
  return std::any_of(targets.begin(), targets.end(), [&](Vec3d t) { return length(place - t) <= kNearTarget; });
}

/// Sum and number, for means over movements.
struct Mean {
  double sum = 0, count = 0;
  void add(double value) {
    if (std::isnan(value)) return;
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / count : kNoMetric; }
};

struct Smoothness {
  Mean ldlj, sparc;
  double movements = 0;
};

void add_movements(std::span<const double> speed, double rate, Smoothness& s) {
  for (const Movement& m : movements(speed, rate)) {
    const std::span<const double> part = speed.subspan(m.first, m.count);
    s.ldlj.add(log_dimensionless_jerk(part, rate));
    s.sparc.add(spectral_arc_length(part, rate));
    ++s.movements;
  }
}

void set_smoothness(const Smoothness& s, HandMetrics& m) {
  m.ldlj = s.ldlj.value();
  m.sparc = s.sparc.value();
  m.movements = s.movements;
}

Vec3d force_of(const TraceSample& s, int kind) {
  if (kind == kPull) return s.pull;
  return kind == kPinch ? Vec3d{s.pinch, 0, 0} : s.contact;
}

std::vector<Vec3d> forces_of(const TraceHand& hand, const Window& window, int kind) {
  std::vector<Vec3d> forces;
  if (!hand.has_forces) return forces;
  forces.reserve(window.count);
  for (std::size_t i = 0; i < window.count; ++i) forces.push_back(force_of(hand.samples[window.first + i], kind));
  return forces;
}

double fraction(const std::vector<char>& flags) {
  if (flags.empty()) return kNoMetric;
  return double(std::count(flags.begin(), flags.end(), 1)) / double(flags.size());
}

/// Everything about one hand; `smoothness` gathers its movements for the total.
HandMetrics hand_metrics(const Trace& trace, std::size_t h, const Motion& motion, const Window& window,
                         const MetricsOptions& options, Smoothness& smoothness) {
  const TraceHand& hand = trace.hands[h];
  const std::span<const Vec3d> tip = window.of(motion.tip);
  const std::span<const Quatd> orientation = window.of(motion.orientation);
  const std::span<const double> speed = window.of(motion.speed);
  HandMetrics m;
  m.name = hand.name;
  m.path = path_length(tip);
  const std::vector<Vec3d> own = own_waypoints(trace, int(h), motion, window);
  const std::vector<Vec3d>& waypoints = given(options.waypoints, h) ? options.waypoints[h] : own;
  if (waypoints.size() > 1) m.reference = path_length(waypoints);
  if (m.path > 0) m.economy = m.reference / m.path;
  if (hand.has_shaft) {
    const std::vector<double> axial = axial_coordinate(tip, orientation);
    m.depth = depth_travel(axial);
    const std::vector<std::size_t> turns = reversals(axial, kDepthReversal);
    m.depth_reversals = double(turns.size());
    const std::vector<Vec3d>& targets = given(options.targets, h) ? options.targets[h] : own;
    if (targets.size() > 1 || given(options.targets, h))
      m.depth_reversals_near =
          double(std::count_if(turns.begin(), turns.end(), [&](std::size_t i) { return near_any(tip[i], targets); }));
  }
  m.angular_path = angular_path(orientation);
  m.mean_jerk = mean_jerk(tip, trace.rate);
  Smoothness mine;
  add_movements(speed, trace.rate, mine);
  add_movements(speed, trace.rate, smoothness);
  set_smoothness(mine, m);
  const std::span<const double> one[] = {speed};
  m.idle = fraction(idle_samples(one, trace.rate));
  m.mean_speed = m.path * trace.rate / double(std::max<std::size_t>(window.count - 1, 1));
  m.peak_speed = *std::max_element(speed.begin(), speed.end());
  for (int k = 0; k < kForceKinds; ++k) {
    const double limit = options.force_limits[std::size_t(k)];
    m.forces[std::size_t(k)] = force_metrics(forces_of(hand, window, k), trace.rate, limit);
  }
  m.forces[kPinch].volume = kNoMetric;  // a number, not a vector
  return m;
}

/// Sum of a member over the hands that have it; NaN if none has.
double summed(const std::vector<HandMetrics>& hands, double HandMetrics::*member) {
  double sum = 0;
  bool any = false;
  for (const HandMetrics& h : hands) {
    if (std::isnan(h.*member)) continue;
    sum += h.*member;
    any = true;
  }
  return any ? sum : kNoMetric;
}

/// All samples of all hands as one: a hand at rest counts with its zeros. The volume is the largest of a hand.
ForceMetrics pooled(const Trace& trace, const Window& window, const std::vector<HandMetrics>& hands, int kind,
                    double limit) {
  std::vector<Vec3d> forces;
  for (const TraceHand& hand : trace.hands) {
    const std::vector<Vec3d> more = forces_of(hand, window, kind);
    forces.insert(forces.end(), more.begin(), more.end());
  }
  ForceMetrics all = force_metrics(forces, trace.rate, limit);
  all.volume = kNoMetric;
  for (const HandMetrics& h : hands) {
    const double volume = h.forces[std::size_t(kind)].volume;
    if (!(all.volume >= volume)) all.volume = volume;
  }
  return all;
}

HandMetrics both_metrics(const std::vector<HandMetrics>& hands) {
  HandMetrics all;
  all.name = "both";
  double measured = 0;  // path of the hands that have a reference
  for (const HandMetrics& h : hands)
    if (!std::isnan(h.reference)) measured += h.path;
  all.path = summed(hands, &HandMetrics::path);
  all.reference = summed(hands, &HandMetrics::reference);
  if (measured > 0) all.economy = all.reference / measured;
  all.depth = summed(hands, &HandMetrics::depth);
  all.depth_reversals = summed(hands, &HandMetrics::depth_reversals);
  all.depth_reversals_near = summed(hands, &HandMetrics::depth_reversals_near);
  all.angular_path = summed(hands, &HandMetrics::angular_path);
  Mean jerk;
  for (const HandMetrics& h : hands) {
    jerk.add(h.mean_jerk);
    all.mean_speed += h.mean_speed / double(hands.size());
    all.peak_speed = std::max(all.peak_speed, h.peak_speed);
  }
  all.mean_jerk = jerk.value();
  return all;
}

/// The two hands with the longest paths, in their order.
std::array<int, 2> busiest(const std::vector<HandMetrics>& hands) {
  std::array<int, 2> best{-1, -1};
  for (int h = 0; h < int(hands.size()); ++h) {
    const auto path = [&](int i) { return i < 0 ? -1 : hands[std::size_t(i)].path; };
    if (path(h) > path(best[0]))
      best = {h, best[0]};
    else if (path(h) > path(best[1]))
      best[1] = h;
  }
  if (best[0] > best[1]) std::swap(best[0], best[1]);
  return best;
}

BimanualMetrics bimanual_metrics(const std::vector<HandMetrics>& hands, const std::vector<Motion>& motions,
                                 const Window& window, std::array<int, 2> pair) {
  BimanualMetrics m;
  const auto there = [&](int h) { return h >= 0 && h < int(hands.size()); };
  if (!there(pair[0]) || !there(pair[1])) pair = busiest(hands);
  if (!there(pair[0]) || pair[0] == pair[1]) return m;
  m.left = pair[0], m.right = pair[1];
  const auto left = std::size_t(m.left), right = std::size_t(m.right);
  const double longer = std::max(hands[left].path, hands[right].path);
  if (longer > 0) m.ratio = std::min(hands[left].path, hands[right].path) / longer;
  const std::span<const double> a = window.of(motions[left].speed), b = window.of(motions[right].speed);
  double any = 0, all = 0;
  for (std::size_t i = 0; i < window.count; ++i) {
    any += a[i] > kMovingSpeed || b[i] > kMovingSpeed;
    all += a[i] > kMovingSpeed && b[i] > kMovingSpeed;
  }
  if (any > 0) m.simultaneous = all / any;
  m.speed_correlation = pearson(a, b);
  return m;
}

}  // namespace

Metrics metrics_of(const Trace& trace, const MetricsOptions& options) {
  Metrics m;
  m.rate = trace.rate;
  m.duration = trace.size() > 0 ? double(trace.size() - 1) / trace.rate : 0;
  m.force_limits = options.force_limits;
  std::vector<Motion> motions;
  for (const TraceHand& hand : trace.hands) motions.push_back(filtered_motion(hand, trace.rate));
  std::vector<Vec3d> eyes;
  for (const TraceScope& s : trace.scope) eyes.push_back(s.eye);
  const PointMotion lens = filtered_points(std::move(eyes), trace.rate);
  std::vector<std::span<const double>> moving;
  for (const Motion& motion : motions) moving.emplace_back(motion.speed);
  if (trace.hands.empty() && !trace.scope.empty()) moving.emplace_back(lens.speed);  // nothing but the endoscope
  const Window window = trace.size() > 0 ? window_of(trace, moving, options.end) : Window{};
  m.camera = camera_metrics(trace, lens, window, options.camera);
  if (window.count < 2) {  // nothing moved
    for (const TraceHand& hand : trace.hands) {
      m.hands.emplace_back();
      m.hands.back().name = hand.name;
    }
    m.both.name = "both";
    return m;
  }
  m.from = trace.time(window.first);
  m.to = trace.time(window.first + window.count - 1);
  m.time = m.to - m.from;
  if (trace.hands.empty()) {
    m.both.name = "both";
    return m;
  }
  Smoothness smoothness;
  std::vector<std::span<const double>> speeds;
  for (std::size_t h = 0; h < trace.hands.size(); ++h) {
    m.hands.push_back(hand_metrics(trace, h, motions[h], window, options, smoothness));
    speeds.push_back(window.of(motions[h].speed));
  }
  m.both = both_metrics(m.hands);
  set_smoothness(smoothness, m.both);
  for (int k = 0; k < kForceKinds; ++k)
    m.both.forces[std::size_t(k)] = pooled(trace, window, m.hands, k, options.force_limits[std::size_t(k)]);
  m.both.idle = fraction(idle_samples(speeds, trace.rate));
  m.bimanual = bimanual_metrics(m.hands, motions, window, options.pair);
  return m;
}

}  // namespace trocar::training
