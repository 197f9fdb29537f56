// Motion without hands: breathing, which carries what the diaphragm carries, and peristalsis
// (tissue/network/force_wave.hpp). Both are functions of the tick alone; nothing of them is State.
//
// Breathing displaces whatever holds bodies in space: springs to space, rigidly held nodes, fixed ends and foundations
// of strands, borders of folds. The displacement is the known curve of a breath [Lujan et al. 1999],
//   u(t) = a sin^4(pi t / T),
// end-expiration in the drawn shape, where bodies stay longest, inspiration half a breath later. A scene begins at
// rest: at t = 0 the displacement and its first three derivatives are zero.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/network/force_wave.hpp>

namespace trocar::sim {

struct BreathingModel {
  double period = 0;                               ///< of a breath [s]; 0: nobody breathes
  Vec3d way{0, 0, 0};                              ///< from end-expiration to end-inspiration where the share is 1 [m]
  std::vector<double> organs, strands, membranes;  ///< (of the Model) share of it that holders of each go along
  std::vector<std::vector<std::int32_t>> held;     ///< (solids) their rigidly held nodes

  bool there() const noexcept { return period > 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("period", s.period), v("way", s.way), v("organs", s.organs), v("strands", s.strands), v("membranes", s.membranes),
        v("held", s.held, core::kNotHashed);
  }
};

/// Waves of one organ. An organ may have several.
struct PeristalsisModel {
  std::int32_t solid = -1;
  tissue::ForceWaveModel wave;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("solid", s.solid), v("wave", s.wave);
  }
};

struct MotionModel {
  BreathingModel breathing;
  std::vector<PeristalsisModel> peristalsis;

  bool there() const noexcept { return breathing.there() || !peristalsis.empty(); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("breathing", s.breathing, core::only_if(s.breathing.there())), v("peristalsis", s.peristalsis);
  }
};

void add_to_hash(core::Hasher& hasher, const MotionModel& motion) noexcept;

}  // namespace trocar::sim
