// What drives the arteries: pressure over a beat, how breathing moves it and how it falls as blood is lost. The shape
// is one of textbooks: upstroke, peak at 0.15 s, notch at 0.35 s, then a decay with 0.6 s, at 72 beats a minute; other
// rates stretch the beat. The notch's height follows from the mean pressure, diastole + a third of the pulse.
#pragma once

#include <array>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar::vessels {

/// How the circulation answers to a loss: factors at a lost volume, straight lines between, constant beyond the last.
/// The volumes are the class limits I .. IV of bleeding for a patient of 70 kg [ATLS]; the factors are our choice.
struct LossResponse {
  double loss = 0;             ///< [m^3]
  double mean = 1, pulse = 1;  ///< of the mean pressure, of the pulse pressure
  double rate = 1;             ///< of the heart rate

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("loss", s.loss), v("mean", s.mean), v("pulse", s.pulse), v("rate", s.rate);
  }
};

struct Heart {
  double rate = 72;             ///< [1/min]
  double systolic = 15999;      ///< 120 mmHg [Pa]
  double diastolic = 10666;     ///< 80 mmHg [Pa]
  std::vector<double> shape;    ///< over a beat in equal steps, scaled to 0 .. 1 by the check; empty = the textbooks'
  double breaths = 14;          ///< [1/min]
  double arterial_swing = 400;  ///< 3 mmHg: amplitude of breathing in the arteries [Pa].  Our choice
  double venous_swing = 267;    ///< 2 mmHg: in the veins [Pa].  Our choice
  std::array<LossResponse, 6> response{{{0, 1, 1, 1},
                                        {0.75e-3, 0.97, 0.9, 1.25},
                                        {1.5e-3, 0.88, 0.7, 1.55},
                                        {2.0e-3, 0.68, 0.5, 1.85},
                                        {2.5e-3, 0.45, 0.4, 1.95},
                                        {3.5e-3, 0.1, 0.3, 0.6}}};

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rate", s.rate), v("systolic", s.systolic), v("diastolic", s.diastolic), v("breaths", s.breaths),
        v("arterial_swing", s.arterial_swing), v("venous_swing", s.venous_swing), v("shape", s.shape, core::kNotHashed),
        v("response", s.response, core::kNotHashed);
  }
};

/// The textbooks' beat in `steps` equal steps: 0 at its start, 1 at its peak, mean 1/3.
std::vector<double> textbook_beat(int steps);

/// Between the knots of `heart.response`.
LossResponse response_to(const Heart& heart, double loss) noexcept;

}  // namespace trocar::vessels
