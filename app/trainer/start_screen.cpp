#include "trainer/start_screen.hpp"

#include <algorithm>
#include <cstring>
#include <random>

#include <fmt/format.h>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

constexpr std::size_t kMostPast = 6;

void set_name(StartMemory& memory, const std::string& name) {
  std::memset(memory.trainee, 0, sizeof memory.trainee);
  std::memcpy(memory.trainee, name.data(), std::min(name.size(), sizeof memory.trainee - 1));
}

/// Letters for those who have no keyboard at hand.
bool draw_letters(StartMemory& memory) {
  bool changed = false;
  std::string name = memory.trainee;
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ";
  const float width = ImGui::GetContentRegionAvail().x, size = 26 * ui::scale();
  const int row = std::max(6, int(width / (size + 4 * ui::scale())));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * ui::scale(), 4 * ui::scale()});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 3 * ui::scale()});
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (i % std::size_t(row) != 0) ImGui::SameLine();
    const std::string label = letters[i] == ' ' ? "_" : std::string(1, letters[i]);
    if (ImGui::Button(label.c_str(), {size, 0}) && name.size() < training::kLongestName) {
      const bool first = name.empty() || name.back() == ' ';
      name += first ? letters[i] : char(std::tolower(letters[i]));
      changed = true;
    }
  }
  ImGui::SameLine();
  if (ImGui::Button("<", {size, 0}) && !name.empty()) {
    do name.pop_back();
    while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xC0) == 0x80);
    changed = true;
  }
  ImGui::SameLine();
  if (ui::button("ok")) memory.letters = false;
  ImGui::PopStyleVar(2);
  if (changed) set_name(memory, name);
  return changed;
}

/// The text field, those who were here before, and letters.
bool draw_trainee(const StartContent& c, StartMemory& memory) {
  bool changed = false;
  ui::text("Your name", ui::kGrey);
  const float letters = 44 * ui::scale(), known = c.past.trainees.empty() ? 0 : 32 * ui::scale();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - letters - known - 8 * ui::scale());
  changed |= ImGui::InputTextWithHint("##trainee", "may stay empty", memory.trainee, sizeof memory.trainee);
  ui::note_widget("Your name");
  if (!c.past.trainees.empty()) {
    ImGui::SameLine(0, 2 * ui::scale());
    if (ImGui::BeginCombo("##known", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft)) {
      for (const std::string& name : c.past.trainees)
        if (ImGui::Selectable(name.empty() ? "(no name)" : name.c_str(), name == memory.trainee)) {
          set_name(memory, name);
          changed = true;
        }
      ImGui::EndCombo();
    }
    ui::note_widget("known names");
  }
  ImGui::SameLine(0, 4 * ui::scale());
  if (ui::button("abc", {.width = 44, .tip = "letters to choose with mouse or gamepad"})) memory.letters ^= true;
  if (memory.letters) changed |= draw_letters(memory);
  return changed;
}

int draw_exercises(const StartContent& c) {
  int chosen = -1;
  ui::text("Exercise", ui::kGrey);
  if (c.exercises.empty()) ui::text("There is none: is the folder of scenes complete?", ui::kOrange);
  for (std::size_t i = 0; i < c.exercises.size(); ++i) {
    const attempt::ExerciseEntry& e = c.exercises[i];
    const std::string label = e.title.empty() ? e.name : e.title;
    if (ui::button(
            label + "##exercise" + std::to_string(i),
            {.width = ImGui::GetContentRegionAvail().x / ui::scale(), .height = 32, .primary = int(i) == c.selected}))
      chosen = int(i);
  }
  return chosen;
}

/// Whose body it is, and where it bleeds: the same number brings the same one back.
std::optional<std::uint64_t> draw_anatomy(const StartContent& c) {
  std::optional<std::uint64_t> chosen;
  ui::text("Anatomy", ui::kGrey);
  const float width = ImGui::GetContentRegionAvail().x / ui::scale(), gap = 4, step = 34, word = 0.27f * width;
  if (ui::button("-##anatomy", {.width = step, .enabled = c.seed > 0, .tip = "the one before"})) chosen = c.seed - 1;
  ImGui::SameLine(0, gap * ui::scale());
  int number = int(std::min<std::uint64_t>(c.seed, kMostAnatomies));
  ImGui::SetNextItemWidth((width - 2 * step - 2 * word - 4 * gap) * ui::scale());
  if (ImGui::InputInt("##anatomy", &number, 0, 0, ImGuiInputTextFlags_EnterReturnsTrue))
    chosen = std::uint64_t(std::clamp(number, 0, int(kMostAnatomies)));
  ui::note_widget("anatomy number");
  ImGui::SameLine(0, gap * ui::scale());
  if (ui::button("+##anatomy", {.width = step, .enabled = c.seed < kMostAnatomies, .tip = "the next one"}))
    chosen = c.seed + 1;
  ImGui::SameLine(0, gap * ui::scale());
  if (ui::button("another", {.width = word, .tip = "somebody whose anatomy is another: organs, and where it bleeds"}))
    chosen = 1 + std::random_device{}() % kMostAnatomies;
  ImGui::SameLine(0, gap * ui::scale());
  if (ui::button("as drawn", {.width = word, .enabled = c.seed != 0, .tip = "0: as the scene's file has it"}))
    chosen = 0;
  return chosen;
}

void draw_devices(const StartContent& c) {
  ui::heading("Devices");
  ui::mark(Mark::done);
  ui::text("mouse and keyboard");
  for (const std::string& name : c.gamepads) {
    ui::mark(Mark::done);
    ui::text(ui::shortened(name, ImGui::GetContentRegionAvail().x));
  }
  if (c.gamepads.empty()) {
    ui::mark(Mark::open);
    ui::text("no gamepad (plug one in at any time)", ui::kGrey);
  }
  if (!c.sound) {
    ui::mark(Mark::open);
    ui::text("no sound device", ui::kGrey);
  }
}

std::string result_text(const PastAttempt& a) {
  if (a.mode == "familiarisation") return "familiarisation";
  if (a.mode == "demonstration") return "demonstration";
  if (a.state == "running") return "not ended";
  const std::string score = a.score ? fmt::format("{:.0f} of 100", *a.score) : "no score";
  if (a.state == "interrupted" || a.state == "aborted") return a.state;
  return score + (a.passed.value_or(false) ? ", passed" : ", not passed");
}

std::int64_t draw_past(const StartContent& c) {
  std::int64_t chosen = 0;
  ui::heading("Last results");
  if (c.past.attempts.empty()) ui::text("None yet.", ui::kGrey);
  for (std::size_t i = 0; i < std::min(kMostPast, c.past.attempts.size()); ++i) {
    const PastAttempt& a = c.past.attempts[i];
    ui::mark(a.passed.value_or(false) ? Mark::done : Mark::note);
    const std::string line = fmt::format("{}  {}", a.when, result_text(a));
    if (ImGui::Selectable(fmt::format("{}##past{}", line, a.number).c_str())) chosen = a.number;
    ui::note_widget(fmt::format("past {}", a.number));
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s: open the report", a.title.empty() ? a.exercise.c_str() : a.title.c_str());
  }
  return chosen;
}

void draw_picture(const StartContent& c, float height) {
  const float room = ImGui::GetContentRegionAvail().x;
  const float width = std::min(room, height * c.facts.aspect), tall = width / c.facts.aspect;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 low{at.x + 0.5f * (room - width), at.y}, high{low.x + width, at.y + tall};
  draw.AddRectFilled({at.x, at.y}, {at.x + room, at.y + tall}, ImGui::GetColorU32({0, 0, 0, 1}), 4);
  if (c.facts.picture != 0) {
    draw.AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(c.facts.picture)), low, high);
  } else {
    const std::string words = !c.failure.empty() ? "cannot be prepared" : "preparing the scene ...";
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    draw.AddText({at.x + 0.5f * (room - size.x), at.y + 0.5f * (tall - size.y)}, ImGui::GetColorU32(ui::kGrey),
                 words.c_str());
  }
  ImGui::Dummy({room, tall});
}

void draw_about(const StartContent& c, float height) {
  ImGui::BeginChild("about", {0, height}, false, ImGuiWindowFlags_NoNav);
  if (!c.failure.empty()) {
    ui::mark(Mark::error);
    ui::text(c.failure, ui::kRed);
  }
  if (!c.facts.summary.empty()) ui::text(c.facts.summary);
  if (!c.facts.facts.empty()) ui::text(fmt::format("{}", fmt::join(c.facts.facts, "   ")), ui::kGrey);
  if (!c.facts.steps.empty()) {
    ui::text("What you will do:", ui::kGrey);
    for (const std::string& steps : c.facts.steps) {
      ui::mark(Mark::note);
      ui::text(steps);
    }
  }
  ImGui::EndChild();
}

}  // namespace

StartAnswer draw_start(const StartContent& c, StartMemory& memory) {
  StartAnswer answer;
  const auto choose = [&answer](bool pressed, StartChoice choice) {
    if (pressed) answer.choice = choice;
  };
  ui::begin_screen("start");
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float left = std::clamp(0.34f * room.x, std::min(230 * ui::scale(), 0.45f * room.x), 380 * ui::scale());

  ImGui::BeginChild("left", {left, 0}, false, ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NavFlattened);
  ui::title("Trocar");
  ui::text("Training in endoscopic surgery", ui::kGrey);
  ImGui::Dummy({0, 4 * ui::scale()});
  answer.selected = draw_exercises(c);
  ImGui::Dummy({0, 2 * ui::scale()});
  answer.seed = draw_anatomy(c);
  answer.trainee_changed = draw_trainee(c, memory);
  draw_devices(c);
  answer.report_of = draw_past(c);
  if (!c.say.empty()) ui::text(c.say, ui::kGrey);
  for (const std::string& n : c.notices) {
    ui::mark(Mark::warning);
    ui::text(n, ui::kOrange);
  }
  ImGui::EndChild();

  ImGui::SameLine(0, 14 * ui::scale());
  ImGui::BeginChild("right", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NavFlattened);
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float buttons = 92 * ui::scale(), picture = std::min(0.62f * (area.y - buttons), area.x / c.facts.aspect);
  draw_picture(c, picture);
  ImGui::Dummy({0, 2 * ui::scale()});
  draw_about(c, std::max(20.0f, ImGui::GetContentRegionAvail().y - buttons));
  const float gap = ImGui::GetStyle().ItemSpacing.x, unit = (area.x - 2 * gap) / 4 / ui::scale();
  const bool task = c.exercises.empty() || c.exercises[std::size_t(c.selected)].task;
  choose(
      ui::button(c.ready ? "Start" : "Start ...", {.width = 2 * unit,
                                                   .height = 42,
                                                   .primary = true,
                                                   .enabled = c.ready,
                                                   .tip = task ? "the exercise, with a score" : "no task, no score"}),
      StartChoice::start);
  if (c.ready && !memory.was_ready && !ImGui::GetIO().WantTextInput) ui::take_focus();
  memory.was_ready = c.ready;
  ImGui::SameLine();
  choose(
      ui::button("Familiarise",
                 {.width = unit, .height = 42, .enabled = c.ready && task, .tip = "the same without clock and score"}),
      StartChoice::familiarise);
  ImGui::SameLine();
  choose(ui::button("Demonstration",
                    {.width = unit, .height = 42, .enabled = c.ready && task, .tip = "watch how it is done"}),
         StartChoice::demonstrate);
  const float small = (area.x - 3 * gap) / 4 / ui::scale();
  choose(ui::button("Last report", {.width = small, .height = 32, .enabled = !c.past.attempts.empty()}),
         StartChoice::report);
  ImGui::SameLine();
  choose(ui::button("Settings", {.width = small, .height = 32}), StartChoice::settings);
  ImGui::SameLine();
  choose(ui::button("Help", {.width = small, .height = 32}), StartChoice::help);
  ImGui::SameLine();
  choose(ui::button("Quit", {.width = small, .height = 32}), StartChoice::quit);
  ImGui::EndChild();
  ImGui::End();
  return answer;
}

/// Two eyes: how, and how deep.
void draw_stereo_settings(Settings& s, bool quad_buffers) {
  ui::text("Two eyes (3D screens and glasses)", ui::kBlue);
  int k = 0;
  for (const pictures::StereoName& n : pictures::kStereoNames) {
    if (k++ % 3 != 0) ImGui::SameLine();
    if (ui::button(n.name, {.width = 190, .primary = s.stereo == n.name, .tip = n.meaning})) s.stereo = n.name;
  }
  if (s.stereo == "off") return;
  if (s.stereo == "quad-buffer" && !quad_buffers)
    ui::text(
        "This window has no quad buffers: one eye is shown. Start again; if that does not help, the graphics "
        "driver has none for this screen.");
  ui::slider("between the eyes [mm]", s.eye_distance, pictures::kLeastBase, pictures::kMostBase, "%.1f", false);
  ui::slider("to what lies on the screen [mm]", s.convergence, pictures::kLeastConvergence, pictures::kMostConvergence,
             "%.0f", true);
  ui::checkbox("eyes exchanged (if what is near looks far)", s.swap_eyes);
}

bool draw_settings(Settings& s, const Settings& before, bool sound, bool quad_buffers) {
  bool closed = false;
  ui::begin_middle("settings", 660);
  ui::title("Settings");
  const float room = 0.97f * ImGui::GetIO().DisplaySize.y - 120 * ui::scale();
  ImGui::BeginChild("list", {0, std::min(room, 500 * ui::scale())}, false, ImGuiWindowFlags_NavFlattened);
  ui::text("Hands", ui::kBlue);
  ui::checkbox("left-handed: mouse buttons, gamepad sides, order of the hands exchanged", s.left_handed);
  ui::checkbox("both hands at once, where a scene has two (H, or both shoulders and Y)", s.both_hands);
  ui::slider("mouse", s.mouse, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider("mouse wheel", s.wheel, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider("keyboard", s.keyboard, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider("gamepad", s.gamepad, kLeastSense, kMostSense, "x %.2f", true);
  ui::text("Turned directions (both: as the handle of a real instrument moves)", ui::kBlue);
  ui::checkbox("instrument sideways", s.invert_x);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox("instrument up and down", s.invert_y);
  ui::checkbox("endoscope sideways", s.invert_view_x);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox("endoscope up and down", s.invert_view_y);
  ui::text("Picture", ui::kBlue);
  ui::checkbox("mirrored picture (left and right exchanged, hands as they are)", s.mirrored_picture);
  draw_stereo_settings(s, quad_buffers);
  ui::text("Text and sound", ui::kBlue);
  ui::slider("text size", s.text_size, kLeastText, kMostText, "x %.2f", false);
  ui::slider(sound ? "sound volume" : "sound volume (no device found)", s.volume, 0, 1, "%.2f", false);
  ui::text("Force on the led hand, for those without a haptic device", ui::kBlue);
  ui::checkbox("drawn", s.force_trace);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox("heard", s.force_sound);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox("felt in the gamepad", s.rumble);
  ui::checkbox("tell the three things to know before an exercise", s.show_hint);
  ImGui::EndChild();
  if (ui::button("Close", {.width = 130, .primary = true})) closed = true;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (ui::button("Undo changes", {.width = 140, .enabled = !(s == before)})) s = before;
  ImGui::SameLine();
  if (ui::button("Defaults", {.width = 130})) {
    Settings fresh;
    fresh.trainee = s.trainee;
    s = fresh;
  }
  ImGui::End();
  return closed;
}

}  // namespace trocar::app
