// What a clip would be worth if the applier closed now: shown beside the picture while somebody gets to know the
// exercise, so that a faulty clip is seen to be one before it is set. The judge uses the same thresholds afterwards.
//
//   if (auto o = clip_outlook(exercise.goal, model, state, hand)) say(o->good());
#pragma once

#include <optional>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

struct ClipOutlook {
  int strand = -1;        ///< whose clip it would be
  bool tube = false;      ///< one of the tubes that are to be clipped
  double s = 0;           ///< from the cornu [m]
  double theta = 0;       ///< off perpendicular [rad]
  double cover = 0;       ///< share of the cross-section between the legs
  int tips_visible = 0;   ///< of the applier's two jaw tips
  bool in_place = false;  ///< where a first or second clip belongs, at a fit distance from those that are there
  bool across = false;    ///< within the angle
  bool encloses = false;  ///< the whole tube
  bool seen() const { return tips_visible == 2; }
  bool good() const { return tube && in_place && across && encloses && seen(); }
};

/// Nothing when that hand leads no loaded clip applier, or nothing lies between its jaws.
std::optional<ClipOutlook> clip_outlook(const Sterilisation& goal, const sim::Model& model, const sim::State& state,
                                        int hand);

}  // namespace trocar::training
