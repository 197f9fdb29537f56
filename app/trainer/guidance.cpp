#include "trainer/guidance.hpp"

#include <fmt/format.h>

#include <trocar/devices/both_hands.hpp>
#include <trocar/devices/mouse_keyboard.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

void key_row(const char* keys, const char* action) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ui::text(keys, ui::kOrange);
  ImGui::TableNextColumn();
  ui::text(action);
}

void key_table(devices::Device device, const char* name, float width) {
  ui::text(name, ui::kBlue);
  if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_None, {width, 0})) return;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.36f);
  ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 0.64f);
  for (const devices::HelpLine& h : devices::help())
    if (h.device == device) key_row(h.keys, h.action);
  if (device == devices::Device::keyboard) {
    key_row("P Esc", "pause: time stops; menu");
    key_row("F1, F12", "this help; save a picture");
    key_row("F2", "another layout: endoscope, outside, analysis; not while it counts");
    key_row("F3", "a second window with the endoscope's picture");
  } else if (device == devices::Device::gamepad) {
    key_row("Start, Back", "pause: time stops; this help");
  }
  ImGui::EndTable();
}

/// What is different while both hands are led.
void both_tables(bool gamepad, float width, bool columns, float gap) {
  const auto table = [width](const char* name, bool pad) {
    ImGui::BeginGroup();
    ui::text(name, ui::kBlue);
    if (ImGui::BeginTable(name, 2, ImGuiTableFlags_None, {width, 0})) {
      ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.36f);
      ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 0.64f);
      for (const devices::HelpLine& h : devices::help_both())
        if ((h.device == devices::Device::gamepad) == pad) key_row(h.keys, h.action);
      ImGui::EndTable();
    }
    ImGui::EndGroup();
  };
  table("Mouse and keyboard", false);
  if (gamepad) {
    if (columns) ImGui::SameLine(0, gap);
    table("Gamepad", true);
  }
  ui::text("All else is as it is for one hand.", ui::kGrey);
}

void one_tables(bool gamepad, float width, bool columns, float gap) {
  ImGui::BeginGroup();
  key_table(devices::Device::keyboard, "Keyboard", width);
  ImGui::EndGroup();
  if (columns) ImGui::SameLine(0, gap);
  ImGui::BeginGroup();
  key_table(devices::Device::mouse, "Mouse", width);
  if (gamepad) key_table(devices::Device::gamepad, "Gamepad", width);
  ImGui::EndGroup();
}

}  // namespace

Choice draw_help(bool gamepad, bool left_handed, bool& both) {
  Choice choice = Choice::none;
  ui::begin_middle("help", gamepad ? 1120 : 980);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const bool columns = size.x > 760 * ui::scale();
  const float gap = 16 * ui::scale(), whole = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const float width = columns ? 0.5f * (whole - gap) : whole;
  const float room = 0.97f * size.y - 92 * ui::scale();
  ui::title(both ? "Both hands at once" : "Keys and buttons");
  ImGui::BeginChild("tables", {0, std::min(room - 20 * ui::scale(), (gamepad ? 620.0f : 470.0f) * ui::scale())}, false);
  both ? both_tables(gamepad, width, columns, gap) : one_tables(gamepad, width, columns, gap);
  if (left_handed)
    ui::text(both ? "Left-handed: mouse buttons, what looks and the order of the hands are exchanged."
                  : "Left-handed: mouse buttons, gamepad sides and the order of the hands are exchanged.",
             ui::kGrey);
  ImGui::EndChild();
  if (ui::button("Close help", {.width = 180, .primary = true})) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (ui::button(both ? "One hand at a time" : "Both hands at once", {.width = 180})) both = !both;
  ImGui::End();
  return choice;
}

namespace {

struct HintTexts {
  const char *lead, *lead_how, *jaws_how;
};

HintTexts hint_texts(bool gamepad, bool both) {
  if (both && gamepad)
    return {"You lead both hands at once.",
            "Each stick moves its side's tip; with that side's shoulder held it goes deeper and back and rolls. Both "
            "shoulders: the endoscope. Both and Y: one hand again.",
            "Each trigger closes its side's jaws, the cross to that side locks and unlocks. Y: another instrument."};
  if (both)
    return {
        "You lead both hands at once.",
        "The mouse moves one tip, its wheel goes deeper and back; arrow keys, W and S lead the other. Tab exchanges "
        "them, 0: the endoscope, H: one hand again.",
        "Left button and G close; a right click meanwhile and Space lock. X or a click with the wheel: another "
        "instrument."};
  if (gamepad)
    return {"You lead one hand at a time; the others stay as they are.",
            "Shoulder buttons: the previous, the next hand. Left stick moves its tip, right stick goes deeper and "
            "back and rolls. Both shoulders and Y: both hands at once.",
            "Right trigger closes, left trigger locks and unlocks. Y: another instrument."};
  return {"You lead one hand at a time; the others stay as they are.",
          "Keys 1, 2, 3 choose it, 0 the endoscope. The mouse or the arrow keys move its tip, the wheel or W and "
          "S go deeper and back. H: both hands at once.",
          "Left button or G closes, Space locks and unlocks. X or a click with the wheel: another instrument."};
}

}  // namespace

Choice draw_hint(bool gamepad, bool both, bool& again) {
  Choice choice = Choice::none;
  ui::begin_middle("hint", 640);
  ui::title("Three things to know");
  ImGui::Dummy({0, 4 * ui::scale()});
  const auto point = [](const char* number, const char* what, const std::string& how) {
    ui::title(number, ui::kOrange);
    ImGui::SameLine(40 * ui::scale());
    ImGui::BeginGroup();
    ui::text(what);
    ui::text(how, ui::kGrey);
    ImGui::EndGroup();
    ImGui::Dummy({0, 4 * ui::scale()});
  };
  const HintTexts texts = hint_texts(gamepad, both);
  point("1", texts.lead, texts.lead_how);
  point("2", "Close the jaws, and lock them to keep what they hold.", texts.jaws_how);
  point("3", "What to do next stands at the right, in the blue box.",
        gamepad ? "Start pauses. Back shows all buttons." : "P pauses. F1 shows all keys.");
  if (ui::button("Begin", {.width = 180, .height = 34, .primary = true})) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox("show this every time", again);
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
