#include "trainer/guidance.hpp"

#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/devices/both_hands.hpp>

#include "guide/device_drawing.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using devices::Device;
using devices::HelpGroup;

void key_row(const std::string& keys, const char* action) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ui::text(keys, ui::kOrange);
  ImGui::TableNextColumn();
  ui::text(action);
}

bool begin_keys(const char* name) {
  if (!ImGui::BeginTable(name, 2)) return false;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.36f);
  ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 0.64f);
  return true;
}

const char* name_of_group(HelpGroup group) {
  return group == HelpGroup::choose ? tr("Choose what you control") : group == HelpGroup::move ? tr("Move") : tr("Act");
}

bool on_page(const devices::HelpLine& line, const HelpPage& page) {
  return (line.device == Device::gamepad) == page.gamepad;
}

/// Lines of a group that apply here; without any the group is left out.
void draw_group(HelpGroup group, const Equipment& equipment, const HelpPage& page) {
  const auto lines = page.both ? devices::help_both() : devices::help();
  const auto applies = [&](const devices::HelpLine& line) {
    return line.group == group && on_page(line, page) && equipment.has(line.needs);
  };
  if (std::none_of(lines.begin(), lines.end(), applies)) return;
  ui::text(name_of_group(group), ui::kBlue);
  if (!begin_keys(name_of_group(group))) return;
  for (const devices::HelpLine& line : lines)
    if (applies(line)) {
      const bool mouse = line.device == Device::mouse && !page.both;
      key_row(mouse ? tr("mouse: {}", tr(line.keys)) : std::string(tr(line.keys)), tr(line.action));
    }
  ImGui::EndTable();
}

void draw_program_keys(const HelpPage& page) {
  ui::text(tr("Program"), ui::kBlue);
  if (!begin_keys("program")) return;
  if (page.gamepad) {
    key_row(tr("Start, Back"), tr("pause and menu; this help"));
  } else {
    key_row("P Esc", tr("pause and menu"));
    key_row("F1, F12", tr("this help; save a picture"));
    key_row("F2", tr("another layout of the picture, while the exercise is not scored"));
    key_row("F11", tr("full screen, and back"));
    key_row("F3, F4", tr("a second window with the endoscope's picture; details in the panel"));
  }
  ImGui::EndTable();
}

void draw_lines(const Equipment& equipment, bool left_handed, const HelpPage& page) {
  for (const HelpGroup group : {HelpGroup::choose, HelpGroup::move, HelpGroup::act}) draw_group(group, equipment, page);
  draw_program_keys(page);
  if (page.both) ui::text(tr("All other keys work as with one hand."), ui::kGrey);
  if (left_handed)
    ui::text(page.both ? tr("Left-handed: mouse buttons, endoscope stick and the order of the hands are exchanged.")
                       : tr("Left-handed: mouse buttons, gamepad sides and the order of the hands are exchanged."),
             ui::kGrey);
}

void draw_device(const Equipment& equipment, bool left_handed, const HelpPage& page, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height =
      page.gamepad ? draw_gamepad(equipment, at, width) : draw_mouse_and_keys(equipment, left_handed, at, width);
  ImGui::Dummy({width, height});
}

/// Two buttons for the devices, the open one is bright.
void draw_tabs(HelpPage& page) {
  if (ui::button(tr("Mouse and keyboard"), {.width = 190, .primary = !page.gamepad})) page.gamepad = false;
  ImGui::SameLine();
  if (ui::button(tr("Gamepad"), {.width = 120, .primary = page.gamepad})) page.gamepad = true;
}

}  // namespace

Choice draw_help(const Equipment& equipment, bool left_handed, HelpPage& page) {
  Choice choice = Choice::none;
  ui::begin_middle("help", 1160);
  constexpr float kDrawing = 460, kShareOfDrawing = 0.46f;  // [px at scale 1] below it words beside the drawing are cut
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ui::title(page.both ? tr("Both hands at once") : tr("Keys and buttons"));
  draw_tabs(page);
  const float room = 0.97f * size.y - 150 * ui::scale();
  ImGui::BeginChild("page", {0, std::min(room, 500 * ui::scale())}, false);
  const float whole = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize, gap = 16 * ui::scale();
  if (whole > kDrawing * ui::scale() / kShareOfDrawing) {
    const float drawing = kShareOfDrawing * (whole - gap);
    ImGui::BeginChild("device", {drawing, 0}, false, ImGuiWindowFlags_NoNav);
    draw_device(equipment, left_handed, page, drawing);
    ImGui::EndChild();
    ImGui::SameLine(0, gap);
    ImGui::BeginChild("lines", {0, 0}, false);
    draw_lines(equipment, left_handed, page);
    ImGui::EndChild();
  } else {
    draw_device(equipment, left_handed, page, std::min(whole, kDrawing * ui::scale()));
    draw_lines(equipment, left_handed, page);
  }
  ImGui::EndChild();
  if (ui::button(tr("Close help"), {.width = 180, .primary = true})) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  if (equipment.hands > 1) {
    ImGui::SameLine();
    if (ui::button(page.both ? tr("One hand at a time") : tr("Both hands at once"), {.width = 190}))
      page.both = !page.both;
  }
  ImGui::End();
  return choice;
}

namespace {

struct HintTexts {
  const char *first, *first_how, *second, *second_how;
};

HintTexts camera_texts(bool gamepad, bool oblique) {
  return {
      tr("You control the endoscope."),
      gamepad ? tr("The left stick turns it. The right stick moves it deeper and back, and rolls the picture.")
              : tr("The mouse or the arrow keys turn it. The wheel, or W and S, moves it deeper and back."),
      oblique ? tr("Keep the horizon level. The light post turns the oblique view.") : tr("Keep the horizon level."),
      gamepad   ? oblique ? tr("Right stick sideways: roll. Triggers: light post.") : tr("Right stick sideways: roll.")
        : oblique ? tr("Roll: drag with the right button, or Q and E. Light post: R and F.")
                : tr("Roll: drag with the right button, or Q and E.")};
}

HintTexts both_texts(bool gamepad) {
  const char* const you = tr("You control both hands at once.");
  const char* const close = tr("Close the jaws. Lock them to keep what they hold.");
  if (gamepad)
    return {you,
            tr("Each stick moves the tip of its side. With that side's shoulder held it moves deeper and back, and "
               "rolls. Both shoulders: the endoscope. Both shoulders and Y: one hand."),
            close,
            tr("Each trigger closes the jaws of its side. The cross to that side locks and unlocks. Y: exchange.")};
  return {you,
          tr("The mouse moves one tip, its wheel moves deeper and back. Arrow keys, W and S move the other. Tab "
             "exchanges them. 0: the endoscope. H: one hand."),
          close, tr("Left button and G close. A right click meanwhile, or Space, locks. X: exchange the instrument.")};
}

HintTexts one_texts(bool gamepad) {
  const char* const you = tr("You control one instrument at a time; the others stay put.");
  const char* const close = tr("Close the jaws. Lock them to keep what they hold.");
  if (gamepad)
    return {you,
            tr("Shoulder buttons: the previous, the next instrument. The left stick moves its tip, the right stick "
               "moves deeper and back, and rolls. Both shoulders and Y: both hands at once."),
            close, tr("The right trigger closes, the left trigger locks and unlocks. Y: exchange the instrument.")};
  return {you,
          tr("Keys 1, 2, 3 choose it, 0 the endoscope. The mouse or the arrow keys move its tip. The wheel, or W and "
             "S, moves deeper and back. H: both hands at once."),
          close, tr("The left button or G closes, Space locks and unlocks. X: exchange the instrument.")};
}

}  // namespace

Choice draw_hint(const Equipment& equipment, bool gamepad, bool both, bool& again) {
  Choice choice = Choice::none;
  ui::begin_middle("hint", 640);
  ui::title(tr("Three things to know"));
  ImGui::Dummy({0, 4 * ui::scale()});
  const auto point = [](const char* number, const char* what, const char* how) {
    ui::title(number, ui::kOrange);
    ImGui::SameLine(40 * ui::scale());
    ImGui::BeginGroup();
    ui::text(what);
    ui::text(how, ui::kGrey);
    ImGui::EndGroup();
    ImGui::Dummy({0, 4 * ui::scale()});
  };
  const HintTexts texts = equipment.hands == 0 ? camera_texts(gamepad, equipment.oblique)
                          : both               ? both_texts(gamepad)
                                               : one_texts(gamepad);
  point("1", texts.first, texts.first_how);
  point("2", texts.second, texts.second_how);
  point("3", tr("The blue box on the right shows your next step, and how near you are."),
        gamepad ? tr("Start pauses. Back shows all buttons.") : tr("P pauses. F1 shows all keys."));
  if (ui::button(tr("Begin"), {.width = 180, .height = 34, .primary = true})) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox(tr("show this every time"), again);
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
