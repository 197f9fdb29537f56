// The first suture of a scene, as judged.
#pragma once

#include <string_view>

#include <trocar/interactions/objects/suture.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/suture/knots/knots.hpp>

namespace trocar::training {

inline bool has_suture(const sim::Model& model) { return !model.objects.sutures.list.empty(); }
inline const interactions::SutureModel& suture_of(const sim::Model& model) {
  return model.objects.sutures.list.front();
}
inline const interactions::SutureState& suture_of(const sim::State& state) { return state.objects.sutures.front(); }

std::string_view needs_suture(const sim::Model& model);
std::string_view needs_needle(const sim::Model& model);
std::string_view needs_thread(const sim::Model& model);

/// From a bite's entry or exit to a mark's middle, in the drawn shape; the nearest of all bites that there are. Below
/// 0: none.
double bite_to_mark(const sim::Model& model, const sim::State& state, int target, bool entry);
/// Ways through that body that needle or thread is in, from end to end.
int passages_through(const sim::State& state, BodyId body);
/// What the hand holds of it: 0 nothing, 1 the needle, 2 the thread.
int held_of_suture(const sim::Model& model, const sim::State& state, std::size_t hand);
/// Thread between a clip's legs and the nearest end of a way through tissue, of several clips the nearest [m]. Below 0:
/// there is none, or the thread goes through nothing.
double clip_to_hole(const interactions::SutureState& suture);
/// Is the needle's middle or its tip where the endoscope points?
bool needle_in_picture(const sim::Model& model, const sim::State& state);
/// From the first throw to the nearest place of the bite: a straight line between places where the thread goes into
/// tissue and comes out [m].
double knot_above_tissue(const sim::Model& model, const sim::State& state, const suture::KnotReading& knot);
suture::KnotReading knot_of(const sim::Model& model, const sim::State& state);
/// Thread from the needle to where it first goes into tissue; all of it where it does not [m].
double arc_to_stitch(const sim::Model& model, const sim::State& state);
/// How often the thread, as far as the stitch if there is one, winds round the hand's jaws, hinge and last centimetres
/// of shaft.
double wraps_around(const sim::Model& model, const sim::State& state, std::size_t hand);

}  // namespace trocar::training
