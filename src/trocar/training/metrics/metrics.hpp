// How the hands moved and how hard they pulled: all motion and force metrics of an attempt, from its Trace alone.
// docs/guides/metrics.md says how each is defined, after whom, and what it is not good for.
//
//   const Metrics m = metrics_of(recorder.trace(), {.end = monitor_seconds});
//   result["metrics"] = nlohmann::ordered_json::parse(metrics_json(m));
//
// SI units. What cannot be computed (no motion, unknown shaft, no reference) is NaN here and null in JSON.
// Portable arithmetic in a fixed order: the same trace gives the same bits everywhere.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <trocar/training/metrics/trace.hpp>

namespace trocar::training {

inline constexpr double kNoMetric = std::numeric_limits<double>::quiet_NaN();

// Our choices.
inline constexpr double kMotionCutoff = 10;      ///< of the low-pass over positions and orientations [Hz]
inline constexpr double kMovingSpeed = 0.005;    ///< a tip that is faster moves [m/s]
inline constexpr double kIdleSpeed = 0.002;      ///< a tip that is slower is idle ...
inline constexpr double kIdleTime = 1;           ///< ... if for at least so long [s]
inline constexpr double kDepthReversal = 0.003;  ///< a turn along the shaft after so much counts [m]
inline constexpr double kNearTarget = 0.020;     ///< within this of a target [m]
inline constexpr double kLeastForce = 0.01;      ///< less is no force: mean non-zero force [N]

enum ForceKind { kPull, kPinch, kContact, kForceKinds };

/// What an exercise for the endoscope alone tells of it; NaN and none elsewhere.
struct CameraWatch {
  double on_target = kNoMetric;        ///< share of the time in which the current step's conditions held
  double lens_touches = kNoMetric;     ///< a count
  std::vector<double> target_seconds;  ///< for each target that was completed, in their order [s]
};

struct MetricsOptions {
  double end = kNoMetric;  ///< time of the final predicate, as in Trace::time [s]; NaN: the last sample
  /// Per hand, the points that the shortest way would lead through, first to last [m]. A hand without any is measured
  /// against its own marks: where it was at the start, when it gripped, let go, clipped or cut, and at the end.
  std::vector<std::vector<Vec3d>> waypoints;
  /// Per hand, what it aimed at [m]; a hand without any takes the places of its marks.
  std::vector<std::vector<Vec3d>> targets;
  std::array<double, kForceKinds> force_limits{4, 15, 4};  ///< [N], see docs/guides/metrics.md
  CameraWatch camera;
  std::array<int, 2> pair{-1, -1};  ///< hands compared; -1: the two with the longest paths
};

/// All NaN where forces were not measured.
struct ForceMetrics {
  double max = 0, mean_nonzero = 0, rms = 0;  ///< [N]
  double impulse = 0;                         ///< integral of the size over time [N s]
  double volume = kNoMetric;                  ///< of the ellipsoid of three standard deviations [N^3]; not for pinch
  double above = 0;                           ///< time above the limit [s]
};

/// Of one hand, or of all hands together.
struct HandMetrics {
  std::string name;
  double path = 0;                             ///< [m]
  double reference = kNoMetric;                ///< shortest way through the waypoints [m]
  double economy = kNoMetric;                  ///< reference / path, 1 = no detour
  double depth = kNoMetric;                    ///< travel along the shaft [m]
  double depth_reversals = kNoMetric;          ///< turns along the shaft, a count
  double depth_reversals_near = kNoMetric;     ///< those near a target, a count
  double angular_path = 0;                     ///< [rad]
  double mean_jerk = kNoMetric;                ///< sqrt(T^5 / (2 L^2) * integral of |p'''|^2 dt)
  double ldlj = kNoMetric, sparc = kNoMetric;  ///< means over the movements
  double movements = 0;                        ///< how many, a count
  double idle = kNoMetric;                     ///< fraction of the time; for all hands: all idle at once
  double mean_speed = 0, peak_speed = 0;       ///< [m/s]
  std::array<ForceMetrics, kForceKinds> forces;
};

struct BimanualMetrics {
  int left = -1, right = -1;             ///< hands compared; -1: fewer than two
  double ratio = kNoMetric;              ///< shorter path / longer path
  double simultaneous = kNoMetric;       ///< time both move / time any moves
  double speed_correlation = kNoMetric;  ///< Pearson
};

/// Of the endoscope. NaN: not known.
struct CameraMetrics {
  double path = kNoMetric;                                     ///< of the lens [m]
  double horizon_mean = kNoMetric, horizon_p95 = kNoMetric;    ///< how far the picture was turned, either way [deg]
  double on_target = kNoMetric, lens_touches = kNoMetric;      ///< as CameraWatch
  double target_mean = kNoMetric, target_longest = kNoMetric;  ///< time per target [s]
};

struct Metrics {
  double from = kNoMetric, to = kNoMetric;  ///< the window that all is measured in [s]
  double duration = 0;                      ///< of the whole trace [s]
  double time = 0;                          ///< its length: first motion of an instrument to the end [s]
  double rate = kTraceRate;                 ///< [Hz]
  std::array<double, kForceKinds> force_limits{};
  std::vector<HandMetrics> hands;
  HandMetrics both;  ///< all hands together
  BimanualMetrics bimanual;
  CameraMetrics camera;
};

Metrics metrics_of(const Trace& trace, const MetricsOptions& options = {});

/// One JSON object.
std::string metrics_json(const Metrics& metrics);
std::string metrics_json(const Trace& trace, const MetricsOptions& options = {});

}  // namespace trocar::training
