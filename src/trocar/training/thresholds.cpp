// The table of thresholds: one row a number, so that the reader, the published schema and the result say the same.
#include <trocar/numerics/portable.hpp>
#include <trocar/training/exercise.hpp>

namespace trocar::training {
namespace {

using S = Sterilisation;
constexpr double kMm = 1e-3, kDegree = portable::pi / 180;

constexpr ThresholdRow one(const char* key, double unit, double low, double high, double S::*member,
                           const char* meaning) {
  return {key, unit, low, high, member, nullptr, meaning};
}
constexpr ThresholdRow both(const char* key, double unit, double low, double high, Range S::*member,
                            const char* meaning) {
  return {key, unit, low, high, nullptr, member, meaning};
}

constexpr ThresholdRow kRows[] = {
    one("survey_s", 1, 0, 60, &S::survey_time, "each organ in view this long without a break"),
    one("organ_share", 1, 0, 1, &S::organ_share, "an organ is in view from this share of its whole surface on"),
    one("trace_to_mm", kMm, 0, 500, &S::trace_to, "the tube is followed from the fimbriae back to here"),
    one("trace_speed_mm_s", kMm, 1, 1000, &S::trace_speed, "following is no faster than this"),
    one("trace_gap_mm", kMm, 0, 100, &S::trace_gap, "a covered stretch that may be skipped"),
    one("trace_pause_s", 1, 0, 60, &S::trace_pause, "out of view longer than this, following starts over"),
    one("trace_touch_mm", kMm, 0, 100, &S::trace_touch, "an instrument's tip this near follows as well as the eye"),
    both("pull_N", 1, 0, 100, &S::present_pull, "pull on the tube while it is presented"),
    one("straightness", 1, 0, 1, &S::present_straightness, "chord over length of the isthmus, at least"),
    both("first_clip_mm", kMm, 0, 500, &S::first_clip, "place of the inner clip from the uterus"),
    both("second_clip_mm", kMm, 0, 500, &S::second_clip, "place of the outer clip"),
    both("clip_distance_mm", kMm, 0, 500, &S::clip_distance, "between the two"),
    one("clip_angle_deg", kDegree, 0, 90, &S::clip_angle, "largest angle from the tube's cross-section"),
    one("clip_oblique_deg", kDegree, 0, 90, &S::clip_oblique, "beyond it a clip is very oblique"),
    one("clip_cover", 1, 0, 1, &S::clip_cover, "share of the cross-section between the legs, at least"),
    one("clip_closing_s", 1, 0, 60, &S::clip_closing, "shortest closing time, from half open"),
    one("ampulla_mm", kMm, 0, 500, &S::ampulla_from, "a clip farther out is on the ampulla"),
    one("cornu_mm", kMm, 0, 500, &S::cornu_to, "a clip nearer to the uterus is too near"),
    one("cut_margin_mm", kMm, 0, 100, &S::cut_margin, "smallest distance of the cut from a clip"),
    one("cut_fraction", 1, 0, 1, &S::cut_fraction, "of the cross-section, at least"),
    one("cut_depth_mm", kMm, 0, 100, &S::cut_depth, "deepest cut into the mesosalpinx"),
    one("check_s", 1, 0, 60, &S::check_time, "both stumps in view this long"),
    one("pull_limit_N", 1, 0, 100, &S::pull_limit, "a harder pull on delicate tissue is an over-force"),
    one("pull_limit_other_N", 1, 0, 100, &S::pull_limit_other, "the same for other tissue"),
    one("pull_excursion_s", 1, 0.001, 10, &S::pull_excursion, "an over-force counts when it lasts this long"),
    one("pinch_limit_N", 1, 0, 200, &S::pinch_limit, "a harder pinch of bowel is an over-force"),
    one("pinch_impulse_N_s", 1, 0, 1e4, &S::pinch_impulse, "pinch times time on bowel, at most"),
    one("blind_s", 1, 0, 60, &S::blind_time, "an instrument may move out of view this long"),
    one("blind_speed_mm_s", kMm, 0, 1000, &S::blind_speed, "faster than this is moving"),
    one("collision_speed_mm_s", kMm, 0, 1000, &S::collision_speed, "instruments that meet faster than this collide"),
    one("insertion_mm", kMm, 0, 290, &S::insertion_depth, "from the trocar; deeper only in view"),
};

}  // namespace

std::span<const ThresholdRow> thresholds() { return kRows; }

}  // namespace trocar::training
