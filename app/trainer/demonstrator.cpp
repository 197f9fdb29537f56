#include "trainer/demonstrator.hpp"

#include <exception>

#include <imgui.h>

#include <trocar/attempt/playback/kept_demonstration.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "shell/ui.hpp"
#include "trainer/feedback.hpp"

namespace trocar::app {

using Stage = attempt::DemonstrationMaker::Stage;

void Demonstrator::ask(const attempt::Lesson& lesson) {
  m_exercise = lesson.name;
  m_seed = lesson.seed;
  m_failure.clear();
  m_file = attempt::kept_demonstration(lesson);
  const auto p = m_maker.progress();
  const bool under_way = m_maker.busy() && p.exercise == lesson.name && p.seed == lesson.seed;
  if (!m_file && !under_way) m_maker.start(lesson.name, lesson.seed);
}

bool Demonstrator::is_of(const attempt::Lesson* lesson) const {
  return lesson && lesson->name == m_exercise && lesson->seed == m_seed;
}

bool Demonstrator::draw(const attempt::Lesson* lesson) {
  const auto p = m_maker.progress();
  if (p.stage == Stage::done && p.exercise == m_exercise && p.seed == m_seed) {
    m_file = p.file;
    m_maker.forget();
  }
  if (m_file && is_of(lesson)) return true;
  draw_progress(p);
  return false;
}

void Demonstrator::draw_progress(const attempt::DemonstrationMaker::Progress& p) {
  const bool nothing = p.stage == Stage::idle || p.stage == Stage::cancelled;
  if (nothing && m_failure.empty() && !m_file) return;
  constexpr float kWide = 420;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x - 14 * ui::scale(), size.y - 14 * ui::scale()}, ImGuiCond_Always, {1, 1});
  ImGui::SetNextWindowSizeConstraints({kWide * ui::scale(), 0}, {kWide * ui::scale(), size.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("demonstration", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleVar();
  if (p.stage == Stage::preparing || p.stage == Stage::recording) {
    ui::text(tr("Recording the demonstration: {}", p.title));
    const std::string label = p.stage == Stage::preparing ? std::string(tr("Preparing the scene"))
                                                          : tr("{:.0f} % ({} of about {})", 100 * p.share(),
                                                               clock_text(p.seconds), clock_text(p.expected));
    ImGui::ProgressBar(float(p.share()), {-1, 0}, label.c_str());
    ui::text(tr("It opens when it is ready. You can use Trocar meanwhile."), ui::kGrey);
    if (ui::button(tr("Cancel"), {.width = 120})) m_maker.cancel();
  } else {
    const std::string why = p.stage == Stage::failed ? p.failure : m_failure;
    if (!why.empty()) ui::text(tr("The demonstration cannot be shown: {}", why), ui::kOrange);
    if (why.empty()) ui::text(tr("The demonstration is ready. Select its exercise to watch it: {}", m_exercise));
    if (ui::button(tr("Close"), {.width = 120})) {
      m_maker.forget();
      m_failure.clear();
      m_file.reset();
      m_exercise.clear();
    }
  }
  ImGui::End();
}

PlayerEnd Demonstrator::play(TrainerWindow& stage, const attempt::Lesson& lesson) {
  const std::filesystem::path file = m_file.value_or(std::filesystem::path());
  m_file.reset();
  m_exercise.clear();
  return play_recording(stage, lesson, file, true, m_failure);
}

PlayerEnd play_recording(TrainerWindow& stage, const attempt::Lesson& lesson, const std::filesystem::path& file,
                         bool demonstration, std::string& failure) {
  try {
    const sim::Recording recording = sim::read_recording(file.string());
    PlayerOptions options;
    options.file = file.string();
    options.exercise = lesson.name;
    options.eyes = stage.eyes();
    options.now_you = demonstration;
    if (demonstration && !attempt::reached_pass_mark(recording.result_json))
      options.note = tr("This demonstration did not reach the pass mark.");
    stage.drop_view();  // the player has one of its own
    stage.window.set_title(demonstration ? tr("Trocar: demonstration of {}", lesson.title)
                                         : tr("Trocar: recording of {}", lesson.title));
    const PlayerEnd end = play_inside(stage.window, *stage.backend, lesson, recording, std::move(options), stage.log);
    stage.log_screen_again();
    return end;
  } catch (const std::exception& bad) {
    failure = bad.what();
    return PlayerEnd::back;
  }
}

}  // namespace trocar::app
