#include "trainer/pause.hpp"

#include <utility>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

bool entry_of_pause(const char* text, bool primary = false) {
  return ui::button(text, {.width = 260, .height = 32, .primary = primary});
}

const char* question_of(Choice asked, bool scored) {
  if (asked == Choice::restart)
    return scored ? tr("Restart the exercise? This attempt ends and counts as not passed.")
                  : tr("Restart? The scene returns to its beginning.");
  return scored ? tr("End the exercise? If steps are open, this attempt counts as not passed.") : tr("End this run?");
}

}  // namespace

Choice PauseMenu::draw(const About& about, bool back) {
  return asks() ? draw_question(about.scored, back) : draw_menu(about);
}

Choice PauseMenu::draw_menu(const About& about) {
  Choice choice = Choice::none;
  ui::begin_middle("pause", 520);
  ui::title(tr("Paused"));
  if (!about.why.empty()) {
    ui::mark(ui::Mark::warning);
    ui::text(about.why, ui::kOrange);
  }
  if (entry_of_pause(tr("Resume"), true)) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  if (entry_of_pause(tr("End exercise"))) m_asked = Choice::finish;
  ImGui::SameLine();
  ui::text(about.scored ? tr("shows the result") : tr("without a score"), ui::kGrey);
  if (entry_of_pause(tr("Restart"))) m_asked = Choice::restart;
  if (entry_of_pause(tr("Keys and buttons"))) choice = Choice::help;
  if (entry_of_pause(tr("Settings"))) choice = Choice::settings;
  if (about.display && entry_of_pause(tr("Display"))) choice = Choice::display;
  if (about.display && entry_of_pause(tr("Views"))) choice = Choice::views;
  if (entry_of_pause(tr("Start screen"))) choice = Choice::start_screen;
  if (entry_of_pause(tr("Quit Trocar"))) choice = Choice::quit;
  if (!about.recording.empty()) ui::text(tr("Recording: {}", about.recording), ui::kGrey);
  ImGui::End();
  return choice;
}

Choice PauseMenu::draw_question(bool scored, bool back) {
  Choice choice = Choice::none;
  ui::begin_middle("confirm", 520);
  ui::mark(ui::Mark::warning);
  ui::text(question_of(m_asked, scored));
  ImGui::Dummy({0, 6 * ui::scale()});
  const bool resume = entry_of_pause(tr("Resume"), true);
  ImGui::SetItemDefaultFocus();
  const Choice asked = m_asked;
  const bool confirmed = entry_of_pause(asked == Choice::restart ? tr("Yes, restart") : tr("Yes, end exercise"));
  ImGui::End();
  if (confirmed) choice = asked;
  if (resume) choice = Choice::resume;
  if (resume || confirmed || back) forget();
  return choice;
}

}  // namespace trocar::app
