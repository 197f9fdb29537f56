// How smooth a movement is, from its speed over time: log dimensionless jerk, spectral arc length, and the split into
// discrete movements that both want. Closer to zero is smoother for all of them.
//
//   for (const Movement& m : movements(speed, 50)) use(spectral_arc_length(speed.subspan(m.first, m.count), 50));
//
// [Balasubramanian 2012] Balasubramanian, Melendez-Calderon, Burdet: A robust and sensitive metric for quantifying
//   movement smoothness. IEEE Trans Biomed Eng 59:2126.
// [Balasubramanian 2015] Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet: On the analysis of movement
//   smoothness. J NeuroEng Rehabil 12:112.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace trocar::training {

/// -T^3 / v_peak^2 * integral of (d2v/dt2)^2 dt. [Balasubramanian 2015]
/// T = n / rate, second differences, v_peak the largest |v|. Dimensionless.
/// @param speed  (n) in any unit
/// @param rate   [Hz]
/// @return NaN for fewer than 3 samples or no speed at all
double dimensionless_jerk(std::span<const double> speed, double rate);

/// -ln of the above's size. NaN also where there is no jerk: a constant speed is not a movement.
double log_dimensionless_jerk(std::span<const double> speed, double rate);

/// Figures of [Balasubramanian 2015].
struct SpectralArcSettings {
  int pad_level = 4;              ///< the spectrum has 2^(ceil(log2 n) + pad_level) points
  double cutoff = 10;             ///< frequencies above are not looked at [Hz]
  double least_amplitude = 0.05;  ///< of the normalised spectrum; what is below at both ends is cut off
};

/// Length of the normalised magnitude spectrum's curve up to the last frequency that matters, negative. Dimensionless.
/// @return NaN for fewer than 2 samples, for no speed, for more than 2^16 samples (22 min of movement at 50 Hz)
double spectral_arc_length(std::span<const double> speed, double rate, const SpectralArcSettings& settings = {});

/// A stretch of samples in which the speed stays at or above a share of its peak.
struct Movement {
  std::size_t first = 0, count = 0;
};
inline constexpr double kMovementShare = 0.05;     ///< of the peak speed
inline constexpr double kShortestMovement = 0.25;  ///< [s]; a shorter one has too few samples to judge. Our choice

std::vector<Movement> movements(std::span<const double> speed, double rate);

}  // namespace trocar::training
