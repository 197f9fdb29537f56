#include "trainer/rack.hpp"

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "trainer/generator.hpp"

namespace trocar::app {
namespace {

/// Keys of a generator: less, more, and what it is set to.
std::uint32_t draw_setting(const char* name, double watts, tissue::PanelKey less, tissue::PanelKey more) {
  std::uint32_t keys = 0;
  ImGui::PushID(name);
  ImGui::PushButtonRepeat(true);
  if (ui::button(" - ")) keys |= less;
  ImGui::SameLine();
  if (ui::button(" + ")) keys |= more;
  ImGui::PopButtonRepeat();
  ImGui::SameLine();
  ui::text(tr("{} {:.0f} W", name, watts), ui::kWhite);
  ImGui::PopID();
  return keys;
}

std::uint32_t draw_panel_keys(const tissue::GeneratorPanel& p) {
  const bool cut = p.yellow == tissue::EnergyMode::cut;
  ui::text(tr("Settings of the generator"), ui::kGrey);
  std::uint32_t keys = draw_setting(cut ? tr("yellow, cut") : tr("yellow, blend"), p.yellow_watts, tissue::kYellowLess,
                                    tissue::kYellowMore);
  ImGui::SameLine();
  if (ui::button(cut ? tr("to blend") : tr("to cut"))) keys |= tissue::kOtherCut;
  keys |= draw_setting(tr("blue, coagulation"), p.blue_watts, tissue::kBlueLess, tissue::kBlueMore);
  keys |= draw_setting(tr("blue, bipolar"), p.bipolar_watts, tissue::kBipolarLess, tissue::kBipolarMore);
  return keys;
}

/// One hand, or both; of both: what the mouse leads.
void draw_mode(const sim::Model& model, const devices::BothHands& both, RackChoice& choice) {
  if (attempt::hand_count(model) < 2) return;
  if (ui::button(both.on ? tr("both hands: on (H)") : tr("both hands: off (H)"))) choice.both = true;
  ImGui::SameLine();
  if (!both.on) return;
  if (ui::button(tr("mouse: hand {} (Tab)", both.pair[size_t(both.mouse)] + 1))) choice.exchange = true;
  ImGui::SameLine();
}

std::string rack_question(const sim::Model& model, const devices::BothHands& both) {
  const int count = attempt::hand_count(model);
  if (!both.on || count < 2) return tr("Choose an instrument (the clock keeps running).");
  if (count == 2)
    return tr("You control hands {} and {}. Choose one (the clock keeps running).", both.pair[0] + 1, both.pair[1] + 1);
  return tr("You control hands {} and {}. Choose one, or a third one that replaces it (the clock keeps running).",
            both.pair[0] + 1, both.pair[1] + 1);
}

}  // namespace

RackChoice draw_rack(const sim::Model& model, const sim::State& state, const devices::BothHands& both,
                     float picture_width) {
  const devices::HandState& hands = both.state;
  RackChoice choice;
  const float width = std::min(640 * ui::scale(), 0.97f * picture_width);
  ImGui::SetNextWindowPos({0.5f * picture_width, 12 * ui::scale()}, ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, ImGui::GetIO().DisplaySize.y});
  ImGui::SetNextWindowBgAlpha(0.93f);
  ImGui::Begin("rack", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ui::text(rack_question(model, both), ui::kGrey);
  for (int h = 0; h <= attempt::hand_count(model); ++h) {
    const bool scope = h == attempt::hand_count(model);
    const int hand = scope ? devices::kScope : h;
    const std::string name =
        scope ? std::string(tr("0 endoscope")) : fmt::format("{} {}", h + 1, attempt::hand_name(model, h));
    if (ui::button(name, {.primary = hands.led == hand})) choice.hand = hand;
    if (!scope) ImGui::SameLine();
  }
  if (hands.led != devices::kScope) {
    const std::vector<attempt::Choosable> list = attempt::choosable(model, state, hands.led);
    ui::text(tr("Instrument in this hand"), ui::kGrey);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i > 0) ImGui::SameLine();
      if (ui::button(list[i].name, {.primary = list[i].held})) choice.instrument = list[i].index;
      if (list[i].held) ImGui::SetItemDefaultFocus();
    }
  }
  if (model.energy.there) choice.panel_keys = draw_panel_keys(state.panel);
  ui::text(tr("Actions"), ui::kGrey);
  if (hands.led != devices::kScope) {
    if (ui::button(tr("into view (V)"))) choice.insert = true;
    ImGui::SameLine();
    if (ui::button(hands.ratchet[size_t(hands.led)] ? tr("unlock jaws (Space)") : tr("lock jaws (Space)")))
      choice.ratchet = true;
    ImGui::SameLine();
  }
  if (ui::button(hands.fine ? tr("fine motion: on") : tr("fine motion: off"))) choice.fine = true;
  draw_mode(model, both, choice);
  if (ui::button(tr("pause (P)"))) choice.pause = true;
  ImGui::SameLine();
  if (ui::button(tr("close (Esc)"))) choice.close = true;
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
