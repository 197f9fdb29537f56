// Low-pass filtering of a whole recorded signal without delay: a Butterworth filter run forwards, then backwards.
//
//   const LowPass filter = butterworth_low_pass(4, 10, 50);   // order 4 each way, 10 Hz, sampled at 50 Hz
//   filter_zero_phase(filter, x);                             // x in place
//
// Both runs together have no phase and twice the order, so the gain at the cut-off is 1/2 (-6 dB), not 1/sqrt(2).
// Ends: the signal is continued by its point reflection in the end value for 3 (order + 1) samples (fewer if it is
// shorter), and each run starts in the steady state of its first value: constants pass unchanged.
// These are the defaults of scipy's filtfilt, with which tools/check_metrics.py compares.
// Offline, but with portable arithmetic in a fixed order: the same bits everywhere.
#pragma once

#include <span>
#include <vector>

namespace trocar::numerics {

/// y = (b0 + b1 / z + b2 / z^2) / (1 + a1 / z + a2 / z^2) x
struct Biquad {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

struct LowPass {
  int order = 0;
  std::vector<Biquad> sections;  ///< order / 2 of them, each with gain 1 at 0 Hz
};

/// By the bilinear transform with the cut-off pre-warped. [Oppenheim & Schafer 2010, section 7.3]
/// @param order   even, 2..12
/// @param cutoff  [Hz], 0 < cutoff < rate / 2
/// @throws std::invalid_argument
LowPass butterworth_low_pass(int order, double cutoff, double rate);

/// In place. Any length; a signal of one sample stays as it is.
void filter_zero_phase(const LowPass& filter, std::span<double> x);

}  // namespace trocar::numerics
