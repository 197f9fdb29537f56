// The tables of thresholds: one row a number, so that the reader, the published schema and the result say the same.
#include <trocar/numerics/portable.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {
namespace {

constexpr double kMm = 1e-3, kDegree = portable::pi / 180, kMl = 1e-6, kMlPerMinute = 1e-6 / 60;

template <auto Goal, auto Member>
constexpr ThresholdRow one(const char* key, double unit, double low, double high, const char* meaning) {
  return {key, unit, low, high, [](Exercise& e) -> double& { return (e.*Goal).*Member; }, nullptr, meaning};
}
template <auto Goal, auto Member>
constexpr ThresholdRow both(const char* key, double unit, double low, double high, const char* meaning) {
  return {key, unit, low, high, nullptr, [](Exercise& e) -> Range& { return (e.*Goal).*Member; }, meaning};
}

/// What all kinds have.
template <auto Goal>
constexpr ThresholdRow kHandling[] = {
    one<Goal, &Handling::pull_limit>("pull_limit_N", 1, 0, 100, "a harder pull on delicate tissue is an over-force"),
    one<Goal, &Handling::pull_limit_other>("pull_limit_other_N", 1, 0, 100, "the same for other tissue"),
    one<Goal, &Handling::pull_excursion>("pull_excursion_s", 1, 0.001, 10,
                                         "an over-force counts when it lasts this long"),
    one<Goal, &Handling::pinch_limit>("pinch_limit_N", 1, 0, 200, "a harder pinch of bowel is an over-force"),
    one<Goal, &Handling::pinch_impulse>("pinch_impulse_N_s", 1, 0, 1e4, "pinch times time on bowel, at most"),
    one<Goal, &Handling::blind_time>("blind_s", 1, 0, 60, "an instrument may move out of view this long"),
    one<Goal, &Handling::blind_speed>("blind_speed_mm_s", kMm, 0, 1000, "faster than this is moving"),
    one<Goal, &Handling::collision_speed>("collision_speed_mm_s", kMm, 0, 1000,
                                          "instruments that meet faster than this collide"),
    one<Goal, &Handling::insertion_depth>("insertion_mm", kMm, 0, 290, "from the trocar; deeper only in view"),
};

constexpr ThresholdRow kSterilisation[] = {
    one<&Exercise::goal, &Sterilisation::survey_time>("survey_s", 1, 0, 60,
                                                      "each organ in view this long without a break"),
    one<&Exercise::goal, &Sterilisation::organ_share>("organ_share", 1, 0, 1,
                                                      "an organ is in view from this share of its whole surface on"),
    one<&Exercise::goal, &Sterilisation::trace_to>("trace_to_mm", kMm, 0, 500,
                                                   "the tube is followed from the fimbriae back to here"),
    one<&Exercise::goal, &Sterilisation::trace_speed>("trace_speed_mm_s", kMm, 1, 1000,
                                                      "following is no faster than this"),
    one<&Exercise::goal, &Sterilisation::trace_gap>("trace_gap_mm", kMm, 0, 100,
                                                    "a covered stretch that may be skipped"),
    one<&Exercise::goal, &Sterilisation::trace_pause>("trace_pause_s", 1, 0, 60,
                                                      "out of view longer than this, following starts over"),
    one<&Exercise::goal, &Sterilisation::trace_touch>("trace_touch_mm", kMm, 0, 100,
                                                      "an instrument's tip this near follows as well as the eye"),
    both<&Exercise::goal, &Sterilisation::present_pull>("pull_N", 1, 0, 100, "pull on the tube while it is presented"),
    one<&Exercise::goal, &Sterilisation::present_straightness>("straightness", 1, 0, 1,
                                                               "chord over length of the isthmus, at least"),
    both<&Exercise::goal, &Sterilisation::first_clip>("first_clip_mm", kMm, 0, 500,
                                                      "place of the inner clip from the uterus"),
    both<&Exercise::goal, &Sterilisation::second_clip>("second_clip_mm", kMm, 0, 500, "place of the outer clip"),
    both<&Exercise::goal, &Sterilisation::clip_distance>("clip_distance_mm", kMm, 0, 500, "between the two"),
    one<&Exercise::goal, &Sterilisation::clip_angle>("clip_angle_deg", kDegree, 0, 90,
                                                     "largest angle from the tube's cross-section"),
    one<&Exercise::goal, &Sterilisation::clip_oblique>("clip_oblique_deg", kDegree, 0, 90,
                                                       "beyond it a clip is very oblique"),
    one<&Exercise::goal, &Sterilisation::clip_cover>("clip_cover", 1, 0, 1,
                                                     "share of the cross-section between the legs, at least"),
    one<&Exercise::goal, &Sterilisation::clip_closing>("clip_closing_s", 1, 0, 60,
                                                       "shortest closing time, from half open"),
    one<&Exercise::goal, &Sterilisation::ampulla_from>("ampulla_mm", kMm, 0, 500,
                                                       "a clip farther out is on the ampulla"),
    one<&Exercise::goal, &Sterilisation::cornu_to>("cornu_mm", kMm, 0, 500, "a clip nearer to the uterus is too near"),
    one<&Exercise::goal, &Sterilisation::cut_margin>("cut_margin_mm", kMm, 0, 100,
                                                     "smallest distance of the cut from a clip"),
    one<&Exercise::goal, &Sterilisation::cut_fraction>("cut_fraction", 1, 0, 1, "of the cross-section, at least"),
    one<&Exercise::goal, &Sterilisation::cut_depth>("cut_depth_mm", kMm, 0, 100, "deepest cut into the mesosalpinx"),
    one<&Exercise::goal, &Sterilisation::check_time>("check_s", 1, 0, 60, "both stumps in view this long"),
};

constexpr ThresholdRow kBleedingControl[] = {
    one<&Exercise::bleeding, &BleedingControl::find_time>("find_s", 1, 0, 60,
                                                          "the bleeding place in view this long without a break"),
    one<&Exercise::bleeding, &BleedingControl::clip_cover>("clip_cover", 1, 0, 1,
                                                           "share of the vessel between the legs, at least"),
    one<&Exercise::bleeding, &BleedingControl::clip_closing>("clip_closing_s", 1, 0, 60,
                                                             "shortest closing time, from half open"),
    one<&Exercise::bleeding, &BleedingControl::stopped_flow>(
        "stopped_mL_min", kMlPerMinute, 0, 1000, "what leaves the vessel in a second, at most, once it is stopped"),
    one<&Exercise::bleeding, &BleedingControl::stopped_time>("stopped_s", 1, 0, 60, "it has been stopped this long"),
    one<&Exercise::bleeding, &BleedingControl::pool_left>("pool_mL", kMl, 0, 1000, "what may be left in the pool"),
    one<&Exercise::bleeding, &BleedingControl::check_time>("check_s", 1, 0, 60, "the dry place in view this long"),
    one<&Exercise::bleeding, &BleedingControl::lost_some>("lost_mL", kMl, 0, 10000, "blood lost: a small bleeding"),
    one<&Exercise::bleeding, &BleedingControl::lost_much>("lost_much_mL", kMl, 0, 10000, "a large one"),
    one<&Exercise::bleeding, &BleedingControl::lost_too_much>("lost_too_much_mL", kMl, 0, 10000,
                                                              "one that fails the attempt"),
    one<&Exercise::bleeding, &BleedingControl::control_within>("control_s", 1, 0, 3600,
                                                               "from its beginning to when it is stopped, at most"),
    one<&Exercise::bleeding, &BleedingControl::clear_within>("clear_s", 1, 0, 3600,
                                                             "from then to a pool that is cleared, at most"),
};

template <auto Member>
constexpr ThresholdRow energy(const char* key, double unit, double high, const char* meaning) {
  return {key, unit, 0, high, [](Exercise& e) -> double& { return e.bleeding.energy.*Member; }, nullptr, meaning};
}
constexpr ThresholdRow kEnergy[] = {
    energy<&EnergyLimits::idle_time>("idle_s", 1, 60, "a pedal may be pressed beside nothing for this long"),
    energy<&EnergyLimits::hook_spread>("hook_spread_mm", kMm, 100,
                                       "tissue dies no farther from a monopolar electrode's edge"),
    energy<&EnergyLimits::bipolar_spread>("bipolar_spread_mm", kMm, 100, "the same between bipolar jaws"),
};

template <auto Goal>
std::vector<ThresholdRow> with_handling(std::span<const ThresholdRow> rows) {
  std::vector<ThresholdRow> all(rows.begin(), rows.end());
  all.insert(all.end(), std::begin(kHandling<Goal>), std::end(kHandling<Goal>));
  return all;
}

}  // namespace

std::span<const ThresholdRow> thresholds(Exercise::Kind kind) {
  static const std::vector<ThresholdRow> sterilisation = with_handling<&Exercise::goal>(kSterilisation);
  static const std::vector<ThresholdRow> bleeding = [] {
    std::vector<ThresholdRow> rows = with_handling<&Exercise::bleeding>(kBleedingControl);
    rows.insert(rows.end(), std::begin(kEnergy), std::end(kEnergy));
    return rows;
  }();
  return kind == Exercise::Kind::sterilisation ? sterilisation : bleeding;
}

}  // namespace trocar::training
