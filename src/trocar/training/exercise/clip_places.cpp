#include <trocar/training/exercise/clip_places.hpp>

namespace trocar::training {

bool well_set(const Sterilisation& goal, const interactions::Clip& clip) {
  return clip.tips_visible == 2 && clip.s <= goal.ampulla_from && clip.s >= goal.cornu_to &&
         clip.cover >= goal.clip_cover && clip.theta <= goal.clip_angle && clip.closing_time >= goal.clip_closing;
}

bool place_of_a_clip(const Sterilisation& goal, double s) {
  return goal.first_clip.holds(s) || goal.second_clip.holds(s);
}

bool are_a_pair(const Sterilisation& goal, double inner, double outer) {
  return goal.first_clip.holds(inner) && goal.second_clip.holds(outer) && goal.clip_distance.holds(outer - inner);
}

}  // namespace trocar::training
