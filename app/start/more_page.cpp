#include <trocar/attempt/paths.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

void draw_devices(const StartContent& c) {
  ui::heading(tr("Devices"));
  ui::mark(ui::Mark::done);
  ui::text(tr("Mouse and keyboard"));
  for (const std::string& name : c.gamepads) {
    ui::mark(ui::Mark::done);
    ui::text(name);
  }
  if (c.gamepads.empty()) {
    ui::mark(ui::Mark::open);
    ui::text(tr("No gamepad. Connect one at any time."), ui::kGrey);
  }
  if (c.sound) return;
  ui::mark(ui::Mark::open);
  ui::text(tr("No sound device. Steps, errors and warnings make no sound."), ui::kGrey);
}

void draw_command_pointers() {
  ui::heading(tr("From the command line"));
  ui::text(tr("trocar report --csv FILE: all results as a table."));
  ui::text(tr("trocar trials FILES: learning curves of a group."));
  ui::text(tr("trocar compare SCENE: both solvers of an organ side by side."));
  ui::text(tr("trocar --help: everything else."));
}

void draw_about() {
  ui::heading(tr("About"));
  ui::text(tr("Trocar {}, an open trainer for endoscopic surgery. Licence: Apache-2.0.", TROCAR_VERSION));
  ui::text(tr("Trocar is not a medical device. No surgeon group has reviewed the exercises, and a score certifies "
              "nothing."),
           ui::kOrange);
  ui::text(tr("Your data is in {}.", attempt::data_folder().string()), ui::kGrey);
}

}  // namespace

void draw_more_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  ui::title(tr("More"));
  constexpr float kWidth = 190;
  const auto big = [](const char* title) { return ui::button(title, {.width = kWidth, .height = 38}); };
  if (big(tr("Settings"))) answer.choice = StartChoice::settings;
  first_focus(memory);
  ui::beside(kWidth);
  if (big(tr("Help"))) answer.choice = StartChoice::help;
  ui::beside(kWidth);
  if (big(tr("Results and reports"))) memory.open(StartPage::recordings);
  ui::beside(kWidth);
  if (big(tr("Change person"))) memory.open(StartPage::person);
  ui::beside(kWidth);
  if (big(tr("Quit"))) answer.choice = StartChoice::quit;
  ImGui::BeginChild("list", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  draw_devices(c);
  draw_command_pointers();
  draw_about();
  ImGui::EndChild();
}

}  // namespace trocar::app
