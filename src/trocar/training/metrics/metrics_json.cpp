#include <cmath>

#include <trocar/core/json.hpp>
#include <trocar/training/metrics/known.hpp>
#include <trocar/training/metrics/metrics.hpp>

namespace trocar::training {
namespace {

constexpr const char* kForceNames[kForceKinds] = {"pull", "pinch", "contact"};

/// A count; whole, so that it is not written with a decimal point.
Json count(double value) { return std::isfinite(value) ? Json(std::int64_t(value)) : Json(nullptr); }

Json force_json(const ForceMetrics& f, double limit) {
  if (!std::isfinite(f.max)) return nullptr;  // not measured
  return {{"max_N", known(f.max)},        {"mean_nonzero_N", known(f.mean_nonzero)},
          {"rms_N", known(f.rms)},        {"impulse_Ns", known(f.impulse)},
          {"volume_N3", known(f.volume)}, {"above_limit_s", known(f.above)},
          {"limit_N", known(limit)}};
}

Json hand_json(const HandMetrics& h, const std::array<double, kForceKinds>& limits) {
  Json j{{"name", h.name},
         {"path_m", known(h.path)},
         {"reference_path_m", known(h.reference)},
         {"economy", known(h.economy)},
         {"depth_m", known(h.depth)},
         {"depth_reversals", count(h.depth_reversals)},
         {"depth_reversals_near_target", count(h.depth_reversals_near)},
         {"angular_path_rad", known(h.angular_path)},
         {"mean_jerk", known(h.mean_jerk)},
         {"ldlj", known(h.ldlj)},
         {"sparc", known(h.sparc)},
         {"movements", count(h.movements)},
         {"idle_fraction", known(h.idle)},
         {"mean_speed_m_per_s", known(h.mean_speed)},
         {"peak_speed_m_per_s", known(h.peak_speed)}};
  for (std::size_t k = 0; k < kForceKinds; ++k) j["forces"][kForceNames[k]] = force_json(h.forces[k], limits[k]);
  return j;
}

/// Null where nothing is known of the endoscope.
Json camera_json(const CameraMetrics& c) {
  if (std::isnan(c.path)) return nullptr;
  return {{"path_m", known(c.path)},
          {"horizon_mean_deg", known(c.horizon_mean)},
          {"horizon_p95_deg", known(c.horizon_p95)},
          {"on_target_share", known(c.on_target)},
          {"lens_touches", count(c.lens_touches)},
          {"seconds_per_target", known(c.target_mean)},
          {"slowest_target_s", known(c.target_longest)}};
}

Json bimanual_json(const Metrics& m) {
  const BimanualMetrics& b = m.bimanual;
  Json pair = Json::array();
  for (const int h : {b.left, b.right})
    if (h >= 0) pair.push_back(m.hands[std::size_t(h)].name);
  return {{"hands", pair},
          {"path_ratio", known(b.ratio)},
          {"simultaneous_fraction", known(b.simultaneous)},
          {"speed_correlation", known(b.speed_correlation)}};
}

}  // namespace

std::string metrics_json(const Metrics& m) {
  Json j{{"sampling_hz", known(m.rate)}, {"low_pass_hz", kMotionCutoff}, {"from_s", known(m.from)},
         {"to_s", known(m.to)},          {"time_s", known(m.time)},      {"duration_s", known(m.duration)},
         {"hands", Json::array()}};
  for (const HandMetrics& h : m.hands) j["hands"].push_back(hand_json(h, m.force_limits));
  j["both"] = hand_json(m.both, m.force_limits);
  j["bimanual"] = bimanual_json(m);
  j["camera"] = camera_json(m.camera);
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string metrics_json(const Trace& trace, const MetricsOptions& options) {
  return metrics_json(metrics_of(trace, options));
}

}  // namespace trocar::training
