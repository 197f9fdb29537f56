#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/labels.hpp>
#include <trocar/training/facts/unit.hpp>

namespace trocar::reports {
namespace {

struct Title {
  std::string_view name;
  const char* title;
};

// Limits first, then details and attributes of acts, each by its name in the files.
constexpr Title kTitles[] = {
    {"aim_deg", "Aim: largest angle off the direction"},
    {"air_mm", "Clear space around the mark"},
    {"ampulla_mm", "Distance from the ampulla"},
    {"apart_mm", "Distance between two clips, middle to middle"},
    {"appendix_impulse_N_s", "Pinch on the appendix, force times time"},
    {"appendix_pinch_N", "Pinch on the appendix"},
    {"artery_outer_mm", "Artery: distance of the outer clip"},
    {"artery_central_mm", "Artery: distance of the central clip"},
    {"aside_N", "Force to hold tissue aside"},
    {"aspirate_s", "Time to aspirate"},
    {"avulses_N", "Pull that avulses the vessel"},
    {"away_mm", "Distance to move away"},
    {"bag_N", "Pull on the bag"},
    {"bag_at_mm", "Height at which the bag is opened"},
    {"bared_mm", "Length of the structure to bare"},
    {"bed_begun_share", "Share of the bed that counts as begun"},
    {"bed_check_s", "Time to check the bed"},
    {"begun_share", "Share that counts as begun"},
    {"bile_spilled_mL", "Bile spilled"},
    {"bipolar_spread_mm", "Heat spread of the bipolar forceps"},
    {"blanched_mm2", "Area of blanched tissue"},
    {"blind_s", "Time a tip may move out of view"},
    {"blind_speed_mm_s", "Speed of a tip out of view"},
    {"breached_mm2", "Area of breached tissue"},
    {"carry_N", "Pull while carrying"},
    {"centred", "Distance from the picture's centre, share of its radius"},
    {"check_s", "Time of the final check"},
    {"clear_s", "Time the field must stay clear"},
    {"clip_angle_deg", "Clip: angle off the cross-section"},
    {"clip_closing_s", "Clip: shortest time to close"},
    {"clip_cover", "Clip: share of the cross-section between its legs"},
    {"clip_distance_mm", "Distance between clips"},
    {"clip_oblique_deg", "Clip: angle that counts as oblique"},
    {"clip_room_mm", "Room to bare for the clips"},
    {"coagulate_mm", "Length to coagulate"},
    {"collision_speed_mm_s", "Speed at which instruments collide"},
    {"control_covered_s", "Time to control a bleeding that is covered"},
    {"control_s", "Time to control a bleeding"},
    {"cornu_mm", "Distance from the uterine cornu"},
    {"cover", "Share of the cross-section between the legs"},
    {"crossing_mm", "Distance at which clips cross"},
    {"cut_depth_mm", "Cut: depth behind the tube"},
    {"cut_fraction", "Cut: share of the cross-section"},
    {"cut_margin_mm", "Cut: distance from the nearest clip"},
    {"cut_room_mm", "Room for the cut between clips"},
    {"deepest_mm", "Largest depth"},
    {"draw_N", "Pull to draw tissue"},
    {"draw_free_N", "Pull to draw freed tissue"},
    {"drawn_N", "Pull on a thread that counts as tight"},
    {"dropped_mm", "Distance that counts as dropped"},
    {"dry_mL_min", "Flow that counts as dry"},
    {"duct_central_mm", "Duct: distance of the central clip"},
    {"duct_near_mm", "Duct: distance that counts as near"},
    {"duct_outer_mm", "Duct: distance of the outer clip"},
    {"facing_deg", "Viewing angle off the target's direction"},
    {"fall_mm", "Height of a fall"},
    {"felt_N", "Pulse that can be felt"},
    {"find_s", "Time to find the bleeding"},
    {"first_clip_mm", "First clip: distance along the tube"},
    {"first_loop_mm", "First loop: distance along the structure"},
    {"flexure_mm", "Distance from the flexure"},
    {"found", "Found: distance from the picture's centre, share of its radius"},
    {"found_s", "Found: time in the picture's centre"},
    {"free_left_mm", "Length still attached"},
    {"free_mm", "Length freed"},
    {"free_share", "Share freed"},
    {"grasps", "Number of grasps"},
    {"hook_spread_mm", "Heat spread of the hook"},
    {"idle_s", "Time of current without tissue contact"},
    {"insertion_mm", "Depth of insertion"},
    {"inside_share", "Share inside"},
    {"left_share", "Share left"},
    {"level_deg", "Horizon: largest tilt"},
    {"look_s", "Time to look"},
    {"lost_mL", "Blood lost"},
    {"lost_much_mL", "Blood lost: much"},
    {"lost_too_much_mL", "Blood lost: too much"},
    {"lost_s", "Time out of the picture"},
    {"mark_mm", "Distance of the mark"},
    {"most_IU", "Largest dose"},
    {"most_share", "Largest share"},
    {"near_mm", "Distance from the lens"},
    {"off_long_mm", "Length that counts as too long"},
    {"off_short_mm", "Length that counts as too short"},
    {"off_mark_mm", "Distance from the mark"},
    {"open_N", "Force to open"},
    {"open_share", "Share open"},
    {"opened_mm", "Width opened"},
    {"organ_share", "Share of the organ in the bag"},
    {"out_mm", "Height above the trocar"},
    {"pause_s", "Pause"},
    {"peel_N", "Force to peel"},
    {"pinch_impulse_N_s", "Pinch, force times time"},
    {"pinch_limit_N", "Pinch limit"},
    {"plate_share", "Share of the cystic plate that is bare"},
    {"pool_mL", "Pooled blood"},
    {"press_N", "Force to press"},
    {"pull_N", "Pull"},
    {"pull_excursion_s", "Time a pull may exceed its limit"},
    {"pull_limit_N", "Pull limit"},
    {"pull_limit_other_N", "Pull limit of other organs"},
    {"rate_off_per_min", "Error of the counted pulse rate"},
    {"run_mm", "Length of bowel to run"},
    {"second_clip_mm", "Second clip: distance from the first"},
    {"seen_share", "Share seen"},
    {"serosa_mm", "Distance from the bowel's serosa"},
    {"shallowest_mm", "Least depth"},
    {"shown_mm", "Length shown"},
    {"shown_off", "Shown: distance from the picture's centre, share of its radius"},
    {"shut_N", "Force that closes the vessel"},
    {"shut_s", "Time to keep the vessel closed"},
    {"spacing_mm", "Spacing"},
    {"spilled_mL", "Bile spilled"},
    {"station_s", "Time at each station"},
    {"stays_mm", "Distance between two loops"},
    {"step_mm", "Length of a step"},
    {"still_s", "Time to hold the picture still"},
    {"stopped_mL_min", "Flow that counts as stopped"},
    {"stopped_s", "Time the bleeding must stay stopped"},
    {"straight_deg", "Largest bend that counts as straight"},
    {"straight_share", "Share that is straight"},
    {"straightness", "Straightness"},
    {"stump_mm", "Length of the stump"},
    {"survey_s", "Time of the survey"},
    {"survey_share", "Share to survey"},
    {"tail_mm", "Length of the thread's tail"},
    {"taken_mm", "Distance of the grasp"},
    {"thread_mm", "Length of thread"},
    {"tilted_deg", "Horizon: tilt that counts as lost"},
    {"tilted_s", "Horizon: time that counts as lost"},
    {"touch_mm", "Distance that counts as a touch"},
    {"turned_mm", "Distance that counts as turned"},
    {"uterus_share", "Share of the uterus"},
    {"view_s", "Time of the view"},
    {"volume_mL", "Volume"},
    {"window_share", "Share of the hepatocystic window that is open"},
    {"wrong_mm", "Pull in the wrong direction"},
    // details and attributes
    {"activated", "Current"},
    {"angle_deg", "Angle off the cross-section"},
    {"area_mm2", "Area"},
    {"artery_mL_min", "Flow in the artery"},
    {"artery_mm", "Artery bared"},
    {"at_mm", "Distance along the structure"},
    {"at_s", "Time"},
    {"bed_share", "Share of the bed freed"},
    {"between_clips", "Between clips"},
    {"between_loops", "Between loops"},
    {"bile_mL", "Bile spilled"},
    {"bleeder_cover", "Share of the bleeding vessel between the legs"},
    {"bridges", "Strands left"},
    {"calibre_mm", "Calibre"},
    {"clipped", "Clips"},
    {"closing_s", "Time to close"},
    {"cut", "Cuts"},
    {"depth_mm", "Depth"},
    {"drug_IU", "Dose"},
    {"duct_mm", "Duct bared"},
    {"fat_left", "Fat lobules left"},
    {"flow_mL_min", "Blood flow"},
    {"fraction", "Share of the cross-section cut"},
    {"gap_mm", "Gap"},
    {"good", "Without error"},
    {"injected", "Injections"},
    {"injected_mL", "Volume injected"},
    {"on", "On"},
    {"on_bleeder", "On the bleeding vessel"},
    {"on_thread", "On thread"},
    {"peak_N", "Largest force"},
    {"pulse_felt_N", "Pulse felt"},
    {"reached_mm", "Reached"},
    {"s_mm", "Distance along the structure"},
    {"since_s", "Time since"},
    {"stretches", "Stretches of thread"},
    {"stumps_closed", "Stumps closed"},
    {"tension_N", "Tension"},
    {"tips_visible", "Tips in view"},
    {"to_clip_mm", "Distance to the nearest clip"},
    {"to_loop_mm", "Distance to the nearest loop"},
    {"to_mark_mm", "Distance to the nearest mark"},
    {"under_liquid", "Under blood"},
    {"upstream", "Upstream of the bleeding"},
    {"code", "Code"},
    {"name", "Name"},
    {"needs", "Requires"},
};

struct Symbol {
  std::string_view suffix;
  const char* symbol;
};
constexpr Symbol kSymbols[] = {{"mL_min", "mL/min"}, {"per_min", "per min"}, {"mm_s", "mm/s"}, {"N_s", "N s"},
                               {"mm2", "mm²"},       {"deg", "°"},           {"C", "°C"}};

constexpr std::string_view kShare = "share";

std::string symbol_of(std::string_view suffix) {
  for (const Symbol& s : kSymbols)
    if (s.suffix == suffix) return s.symbol;
  return std::string(suffix);
}

bool is_share(std::string_view name) {
  return name == "clip_cover" || name == "cut_fraction" || name == "fraction" || name == "cover" ||
         name == "bleeder_cover" || (name.size() > kShare.size() && name.ends_with("_share"));
}

const char* title_of(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kTitles), std::end(kTitles), [name](const Title& t) { return t.name == name; });
  return found == std::end(kTitles) ? nullptr : found->title;
}

}  // namespace

std::string in_plain_words(std::string_view name, bool sentence) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return sentence ? core::with_capital(std::move(words)) : words;
}

Label label_of(std::string_view name) {
  Label label;
  std::string_view rest = name;
  const std::string_view suffix = training::unit_of(name).suffix;
  if (!suffix.empty()) {
    label.unit = symbol_of(suffix);
    rest.remove_suffix(suffix.size() + 1);
  } else if (is_share(name)) {
    label.unit = "%";
    label.scale = 100;
  }
  const char* title = title_of(name);
  label.title = title ? tr(title) : in_plain_words(rest, true);
  return label;
}

std::string plain_number(double value) {
  if (!std::isfinite(value)) return "–";
  const double size = std::fabs(value);
  std::string text = fmt::format("{:.{}f}", value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

namespace {

std::string with_unit(const std::string& number, const Label& label) {
  if (label.unit.empty()) return number;
  return number + (label.unit == "°" ? "" : " ") + label.unit;
}

}  // namespace

std::string quantity(double value, const Label& label) { return with_unit(plain_number(value * label.scale), label); }

std::string quantity(double from, double to, const Label& label) {
  return with_unit(tr("{} to {}", plain_number(from * label.scale), plain_number(to * label.scale)), label);
}

}  // namespace trocar::reports
