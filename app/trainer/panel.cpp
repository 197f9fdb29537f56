#include "trainer/panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>

#include "guide/instrument_icon.hpp"
#include "guide/nearness_view.hpp"
#include "shell/ui.hpp"
#include "trainer/generator.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

constexpr float kNarrowest = 250, kWidest = 340, kPanelShare = 0.27f;

const ImVec4 kHintText{0.82f, 0.86f, 0.90f, 1};

void draw_time(const PanelContent& c) {
  ui::title(clock_text(c.now.seconds));
  ImGui::SameLine(0, 10 * ui::scale());
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 6 * ui::scale());
  if (c.paused)
    ui::text(tr("paused"), ui::kOrange);
  else if (c.now.speed < 0.97)
    ui::text(tr("slow motion: slow computer"), ui::kOrange);
  else
    ui::text(c.mode.empty() ? c.trainee : c.mode, ui::kGrey);
}

/// The lines of the box that says what is to be done now, above the rows that say how near it is.
struct NowText {
  std::string head, name, hint;
  std::vector<std::string> keys;
  std::string refusal;
};

NowText now_text(const PanelContent& c) {
  if (c.now.current_step >= int(c.steps.size())) return {tr("Well done"), tr("All steps done"), "", {}, c.refusal};
  const training::StepStatus& step = c.steps[size_t(c.now.current_step)];
  const std::string& pattern = step.hint_pattern.empty() ? step.hint : step.hint_pattern;
  return {tr("Now: step {} of {}", c.now.current_step + 1, c.steps.size()), step.name,
          core::with_keys(pattern, c.device_in_use), c.key_lines, c.refusal};
}

float height_of(const std::string& text, float width) {
  return text.empty() ? 0 : ImGui::CalcTextSize(ui::wrapped(text, width).c_str()).y + ImGui::GetStyle().ItemSpacing.y;
}

float now_height(const NowText& t, const std::vector<training::Nearness>& rows, float wrap) {
  const float marked = wrap - 22 * ui::scale();
  float height = height_of(t.head, wrap) + height_of(t.name, marked) + height_of(t.hint, wrap) +
                 height_of(t.refusal, marked) + nearness_height(rows, wrap);
  for (const std::string& line : t.keys) height += height_of(line, wrap);
  return height;
}

void draw_refusal(const std::string& why) {
  if (why.empty()) return;
  ui::mark(Mark::warning);
  ui::text(why, ui::kOrange);
}

/// The step that is to be done now, how, and how near it is, in a box that is seen first.
void draw_now(const PanelContent& c) {
  if (c.steps.empty()) {
    ui::text(tr("Free practice: no task, no score."), ui::kGrey);
    return draw_refusal(c.refusal);
  }
  const NowText t = now_text(c);
  const bool over = c.now.current_step >= int(c.steps.size());
  const float width = ImGui::GetContentRegionAvail().x, pad = 8 * ui::scale(), wrap = width - 2 * pad;
  const float height = 2 * pad + now_height(t, c.now.nearness, wrap) - ImGui::GetStyle().ItemSpacing.y;
  ImGui::PushStyleColor(ImGuiCol_ChildBg, {0.08f, 0.22f, 0.34f, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad});
  ImGui::BeginChild("now", {width, height}, false,
                    ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysUseWindowPadding |
                        ImGuiWindowFlags_NoScrollbar);
  ui::text(t.head, ui::kBlue);
  ui::mark(over ? Mark::done : Mark::now);
  ui::text(t.name);
  if (!t.hint.empty()) ui::text(t.hint, kHintText);
  for (const std::string& line : t.keys) ui::text(line, ui::kOrange);
  draw_refusal(t.refusal);
  draw_nearness(c.now.nearness);
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

/// Is hand `h` controlled just now, alone or as one of two?
bool leads(const PanelContent& c, int h) {
  if (!c.hands) return false;
  if (!c.both) return c.hands->led == h;
  return !c.both->looking && (c.both->pair[devices::kLeft] == h || c.both->pair[devices::kRight] == h);
}

/// What moves this side of both.
const char* leader_of(const PanelContent& c, int side) {
  if (c.gamepad) return side == devices::kLeft ? tr("left stick") : tr("right stick");
  return side == c.both->mouse ? tr("mouse") : tr("keyboard");
}

/// Costs no line of its own: the panel is full.
std::string hands_heading(const PanelContent& c) {
  if (!c.hands) return tr("Instruments");
  if (!c.both) return tr("You control");
  return tr("Left: {}. Right: {}.", leader_of(c, devices::kLeft), leader_of(c, devices::kRight));
}

/// What is left in a syringe, and what came when its plunger was drawn.
std::string syringe_in_words(const PanelContent& c, int h) {
  const sim::NeedleHand& n = c.now.state.injection.hands[size_t(h)];
  const double left = fluids::kM3PerPicolitre * 1e6 * double(n.left);
  if (n.blood > 0) return tr("{:.1f} mL left, blood comes", left);
  if (n.in() && n.drawn_for > 0) return tr("{:.1f} mL left, no blood in {:.1f} s", left, n.drawn_for);
  if (c.hands && c.hands->ratchet[size_t(h)]) return tr("{:.1f} mL left, needle drawn in", left);
  return tr("{:.1f} mL left", left);
}

/// A line with a drawing; what is controlled is bright on blue.
void draw_controllable(const PanelContent& c, int hand, bool led, const std::string& what, const std::string& state) {
  const float line = ImGui::GetTextLineHeight(), pad = 3 * ui::scale(), room = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos(), icon{2.2f * line, 0.9f * line};
  const float indent = icon.x + 8 * ui::scale();
  const float wrap = room - indent - pad;
  const bool beside = ImGui::CalcTextSize((what + "  " + state).c_str()).x < wrap;
  const std::string text = state.empty() || beside ? ui::wrapped(what, wrap) : what + "\n" + state;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float height = ImGui::CalcTextSize(text.c_str()).y;
  if (led)
    draw.AddRectFilled({at.x - pad, at.y - pad}, {at.x + room, at.y + height + pad},
                       ImGui::GetColorU32({0.10f, 0.36f, 0.55f, 1}), 4);
  const ImU32 colour = ImGui::GetColorU32(led ? ui::kWhite : ui::kGrey);
  const ImVec2 corner{at.x + pad, at.y + 0.5f * (line - icon.y)};
  if (hand == devices::kScope)
    draw_endoscope_icon(draw, corner, icon, colour);
  else
    draw_instrument_icon(draw, attempt::held_by(c.lesson.model, c.now.state, hand).can(), corner, icon, colour);
  draw.AddText({at.x + indent, at.y}, colour, text.c_str());
  if (beside && !state.empty())
    draw.AddText({at.x + indent + ImGui::CalcTextSize((what + "  ").c_str()).x, at.y}, ImGui::GetColorU32(ui::kBlue),
                 state.c_str());
  ImGui::Dummy({room, height});
}

void draw_hand(const PanelContent& c, int h) {
  const interactions::ToolState& tool = c.now.state.tools[size_t(h)];
  const interactions::ToolModel& held = attempt::held_by(c.lesson.model, c.now.state, h);
  std::string about = attempt::in_words(held.name);
  if (held.clips > 0) about = tr("{}, {} clips", about, tool.clips_left);
  std::string state;
  if (tool.holds > 0) state = tr("holds");
  if (c.hands && c.hands->ratchet[size_t(h)]) state = state.empty() ? tr("locked") : tr("holds, locked");
  if (const std::string flow = attempt::flow_in_words(c.now.state, h); !flow.empty()) state = flow;
  if (held.can().inject) state = syringe_in_words(c, h);
  const std::string where = attempt::hand_name(c.lesson.model, h);
  const std::string what = where == attempt::in_words(held.name) ? fmt::format("{} {}", h + 1, about)
                                                                 : fmt::format("{} {}: {}", h + 1, where, about);
  draw_controllable(c, h, leads(c, h), what, state);
}

/// A clip wants to be closed slowly, and no device does so unasked.
void draw_slowly(const PanelContent& c, int h) {
  if (!leads(c, h) || attempt::held_by(c.lesson.model, c.now.state, h).clips == 0) return;
  ui::text(c.hands->fine ? tr("Fine motion is on: the jaws close slowly.")
           : c.gamepad   ? tr("Close slowly: press the left stick, then pull the trigger.")
                         : tr("Close slowly: hold Shift as well."),
           ui::kOrange);
}

const char* valves_of(const PanelContent& c, int h) {
  if (!c.both)
    return c.gamepad ? tr("right trigger: suction, left trigger: water")
                     : tr("D or left button: suction, A or right: water");
  const int side = c.both->pair[devices::kLeft] == h ? devices::kLeft : devices::kRight;
  if (c.gamepad)
    return side == devices::kLeft ? tr("left trigger: suction, cross left: water")
                                  : tr("right trigger: suction, cross right: water");
  return side == c.both->mouse ? tr("left button: suction, right: water") : tr("D: suction, A: water");
}

const char* plunger_of(const PanelContent& c, int h) {
  if (!c.both)
    return c.gamepad ? tr("right trigger: draw the plunger, left: press it; right stick pressed: needle in, out")
                     : tr("D or left button: draw the plunger, A or right: press it; Space: needle in, out");
  const int side = c.both->pair[devices::kLeft] == h ? devices::kLeft : devices::kRight;
  if (c.gamepad)
    return side == devices::kLeft ? tr("left trigger: draw, cross left: press; right stick pressed: needle in, out")
                                  : tr("right trigger: draw, cross right: press; right stick pressed: needle in, out");
  return side == c.both->mouse ? tr("left button: draw, right: press; left held, right click: needle in, out")
                               : tr("D: draw the plunger, A: press it; Space: needle in, out");
}

const char* switches_of(const PanelContent& c, int h) {
  if (!c.both)
    return c.gamepad ? tr("right trigger: coagulate, left: cut") : tr("G or left button: coagulate, Space: cut");
  const int side = c.both->pair[devices::kLeft] == h ? devices::kLeft : devices::kRight;
  if (c.gamepad)
    return side == devices::kLeft ? tr("left trigger: coagulate, cross left: cut")
                                  : tr("right trigger: coagulate, cross right: cut");
  return side == c.both->mouse ? tr("left button: coagulate, N: cut") : tr("G: coagulate, Space: cut");
}

/// Two buttons that no other instrument has.
void draw_buttons(const PanelContent& c, int h) {
  if (!leads(c, h)) return;
  if (attempt::held_by(c.lesson.model, c.now.state, h).can().inject)
    ui::text(plunger_of(c, h), ui::kOrange);
  else if (attempt::has_valves(c.lesson.model, c.now.state, h))
    ui::text(valves_of(c, h), ui::kOrange);
  if (attempt::is_bare_electrode(c.lesson.model, c.now.state, h)) ui::text(switches_of(c, h), ui::kOrange);
}

/// Where the fluids are, two to a line.
void draw_fluids(const PanelContent& c) {
  const std::vector<std::string> account = attempt::fluid_account(c.lesson.model, c.now.state);
  for (std::size_t i = 0; i < account.size(); i += 2)
    ui::text(account[i] + (i + 1 < account.size() ? "   " + account[i + 1] : ""), ui::kGrey);
}

void draw_patient(const PanelContent& c) {
  for (const std::string& line : attempt::patient_in_words(c.lesson.model, c.now.state)) ui::text(line, ui::kGrey);
}

/// A fogged lens, and the key that wipes it, where a person controls it.
void draw_lens(const PanelContent& c) {
  const std::string lens = attempt::lens_in_words(c.lesson.model, c.now.state);
  if (lens.empty()) return;
  const bool hint = c.hands && !(c.now.state.fluids.smoke.wipe_left > 0);
  ui::text(hint ? tr("{}: {} wipes it", lens, core::key_label("wipe_lens", c.device_in_use)) : lens, ui::kOrange);
}

void draw_hands(const PanelContent& c) {
  for (int h = 0; h < attempt::hand_count(c.lesson.model); ++h) {
    draw_hand(c, h);
    draw_slowly(c, h);
    draw_buttons(c, h);
  }
  const bool scope = c.hands && (c.both ? c.both->looking : c.hands->led == devices::kScope);
  draw_controllable(c, devices::kScope, scope, tr("0 endoscope"), "");
  if (!c.hands) ui::text(tr("controlled by {}", c.input), ui::kGrey);
}

/// What an act would be worth if it were done now: depth and angle are hard to judge in a flat picture at first.
void draw_outlook(const PanelContent& c) {
  if (!c.outlook) return;
  ui::heading(tr("If you close now"));
  if (!c.outlook->on.empty()) ui::text(tr("between the jaws: {}", attempt::in_words(c.outlook->on)), ui::kGrey);
  for (const training::Foretold::Finding& f : c.outlook->findings) {
    ui::mark(f.fits ? Mark::done : Mark::warning);
    ui::text(f.text, f.fits ? ui::kWhite : ui::kOrange);
  }
}

/// The hardest pull of all hands; its limit is a line in the bar, and a word says when it is passed.
void draw_pull(const PanelContent& c) {
  if (attempt::hand_count(c.lesson.model) == 0) return;
  double pull = 0;
  for (int h = 0; h < attempt::hand_count(c.lesson.model); ++h) pull = std::max(pull, attempt::pull_on(c.now.state, h));
  const bool over = pull > c.pull_limit, near = pull > 0.8 * c.pull_limit;
  const float width = ImGui::GetContentRegionAvail().x, height = 20 * ui::scale();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const double most = 1.25 * c.pull_limit;
  const auto x_of = [&](double f) { return at.x + width * float(std::min(1.0, f / most)); };
  const ImVec4 colour = over ? ui::kRed : near ? ui::kOrange : ImVec4{0.20f, 0.50f, 0.72f, 1};
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ImGui::GetColorU32({0.20f, 0.22f, 0.26f, 1}), 3);
  if (pull > 0) draw.AddRectFilled(at, {x_of(pull), at.y + height}, ImGui::GetColorU32(colour), 3);
  for (const double limit : {0.8 * c.pull_limit, c.pull_limit})
    draw.AddLine({x_of(limit), at.y}, {x_of(limit), at.y + height},
                 ImGui::GetColorU32(limit < c.pull_limit ? ui::kOrange : ui::kWhite), 2 * ui::scale());
  const std::string label = over   ? tr("pull {:.1f} N  TOO HARD", pull)
                            : near ? tr("pull {:.1f} N  careful", pull)
                                   : tr("pull {:.1f} N (max {:g} N)", pull, c.pull_limit);
  draw.AddText({at.x + 6 * ui::scale(), at.y + 0.5f * (height - ImGui::GetTextLineHeight())},
               ImGui::GetColorU32(over || near ? ImVec4{0, 0, 0, 1} : ui::kWhite), label.c_str());
  ImGui::Dummy({width, height});
}

double push_at_trocars(const PanelContent& c) {
  double push = 0;
  for (int h = 0; h < attempt::hand_count(c.lesson.model); ++h)
    push = std::max(push, attempt::push_at_trocar(c.lesson.model, c.now.state, h));
  return push;
}

/// The force of the last seconds as a line, the pulse in it as another one below, each with its own scale.
void draw_trace(const PanelContent& c) {
  if (!c.feel) return;
  const std::vector<ForceFeel::Sample>& trace = c.feel->trace();
  const float width = ImGui::GetContentRegionAvail().x, height = 64 * ui::scale(), upper = 0.6f * height;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ImGui::GetColorU32({0.13f, 0.15f, 0.18f, 1}), 3);
  draw.AddLine({at.x, at.y + upper}, {at.x + width, at.y + upper}, ImGui::GetColorU32({0.30f, 0.32f, 0.36f, 1}));
  const double most = c.feel->most(), pulse = c.feel->most_pulse(), end = trace.empty() ? 0 : trace.back().time;
  const auto line = [&](auto share_of, float top, float tall, const ImVec4& colour) {
    std::vector<ImVec2> points;
    for (const ForceFeel::Sample& s : trace)
      points.push_back({at.x + width * float(1 + (s.time - end) / ForceFeel::kSeconds),
                        at.y + top + tall * (1 - 0.92f * float(std::clamp(share_of(s), 0.0, 1.0)))});
    draw.AddPolyline(points.data(), int(points.size()), ImGui::GetColorU32(colour), 0, 1.6f * ui::scale());
  };
  line([&](const ForceFeel::Sample& s) { return s.felt.force / most; }, 0, upper - 1, ui::kBlue);
  line([&](const ForceFeel::Sample& s) { return s.felt.pulse / pulse; }, upper, height - upper - 1, ui::kOrange);
  const double now = trace.empty() ? 0 : trace.back().felt.force;
  const float pad = 4 * ui::scale();
  draw.AddText({at.x + pad, at.y + 1}, ImGui::GetColorU32(ui::kGrey), tr("force {:.2f} N", now).c_str());
  draw.AddText({at.x + pad, at.y + upper}, ImGui::GetColorU32(ui::kGrey), tr("pulse"));
  ImGui::Dummy({width, height});
}

/// Of the generator what a trainee has to see at once: current that flows, and warnings; with `all` its settings too.
void draw_generator(const PanelContent& c, bool all) {
  for (const GeneratorLine& line : generator_lines(c.lesson.model, c.now.state))
    if (all != (line.warning || line.on))
      ui::text(line.text, line.warning ? ui::kRed : line.on ? ui::kOrange : ui::kGrey);
}

/// Opens and closes the details: by a key, or by the pointer while the simulation is paused.
void draw_details_line(const PanelContent& c) {
  const char* label = *c.details ? tr("Details (F4 hides them)") : tr("Details (F4)");
  ImGui::PushStyleColor(ImGuiCol_Text, ui::kGrey);
  if (ImGui::Selectable(label, false)) *c.details = !*c.details;
  ImGui::PopStyleColor();
}

/// Figures that no trainee needs in order to continue.
void draw_details(const PanelContent& c, float height) {
  ImGui::BeginChild("details", {0, height}, false, ImGuiWindowFlags_NoNav);
  ui::text(tr("Speed: {:.2f} of real time", c.now.speed), ui::kGrey);
  if (attempt::hand_count(c.lesson.model) > 0)
    ui::text(tr("Force at the trocar: {:.1f} N", push_at_trocars(c)), ui::kGrey);
  draw_patient(c);
  draw_fluids(c);
  draw_generator(c, true);
  if (!c.device.empty()) ui::text(c.device, ui::kGrey);
  ImGui::EndChild();
}

void draw_steps(const PanelContent& c, float height) {
  ImGui::BeginChild("steps", {0, height}, false, ImGuiWindowFlags_NoNav);
  for (std::size_t i = 0; i < c.steps.size(); ++i) {
    const bool done = i < c.now.step_done.size() && c.now.step_done[i], current = int(i) == c.now.current_step;
    const bool missed = i < c.now.step_missed.size() && c.now.step_missed[i];
    ui::mark(done ? Mark::done : missed ? Mark::error : current ? Mark::now : Mark::open);
    ui::text(c.steps[i].name, done ? ui::kBlue : current ? ui::kWhite : ui::kGrey);
    if (current) ImGui::SetScrollHereY(0.4f);
  }
  ImGui::EndChild();
}

const char* foot_of(const PanelContent& c) {
  if (attempt::hand_count(c.lesson.model) == 0)
    return c.gamepad ? tr("Start: pause   Back: help") : tr("P: pause   F1: help");
  return c.gamepad ? tr("Y: instruments   Start: pause   Back: help") : tr("X: instruments   P: pause   F1: help");
}

void draw_list(const Feedback& feedback, float height) {
  ImGui::BeginChild("events", {0, height}, false, ImGuiWindowFlags_NoNav);
  const std::vector<Notice>& all = feedback.all();
  for (const Notice& n : all) {
    ui::mark(n.mark);
    ui::text(fmt::format("{} {}", clock_text(n.clock), n.text), n.mark == Mark::note ? ui::kGrey : ui::kWhite);
  }
  if (!all.empty()) ImGui::SetScrollHereY(1);
  ImGui::EndChild();
}

/// The steps and what happened, above the foot.
void draw_progress(const PanelContent& c, float line, float foot) {
  ui::heading(tr("Steps"));
  const float left_over = ImGui::GetContentRegionAvail().y - foot - 1.9f * line;
  const float wanted = line * float(c.steps.size()) + 4 * ui::scale();
  draw_steps(c, std::max(2 * line, std::min(wanted, 0.55f * left_over)));
  ui::heading(tr("What happened"));
  draw_list(c.feedback, std::max(line, ImGui::GetContentRegionAvail().y - foot));
}

}  // namespace

float panel_width(float width, float scale) {
  return std::min(0.5f * width, std::clamp(kPanelShare * width, kNarrowest * scale, kWidest * scale));
}

void draw_panel(const PanelContent& c, float left, float width, float height) {
  ImGui::SetNextWindowPos({left, 0});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleVar();
  draw_time(c);
  draw_now(c);
  ui::heading(hands_heading(c));
  draw_hands(c);
  ImGui::Dummy({0, 2 * ui::scale()});
  draw_pull(c);
  draw_trace(c);
  draw_lens(c);
  draw_generator(c, false);
  draw_outlook(c);
  for (const std::string& line : c.team) ui::text(line, ui::kGrey);
  draw_details_line(c);
  const float line = ImGui::GetTextLineHeightWithSpacing(), foot = line + 2 * ui::scale();
  if (*c.details)
    draw_details(c, std::max(line, ImGui::GetContentRegionAvail().y - foot));
  else
    draw_progress(c, line, foot);
  ui::text(foot_of(c), ui::kGrey);
  ImGui::End();
}

namespace {

/// A box over the picture that takes no input. @param at [px]  @param hold  which of its points lies there [shares]
void begin_box(const char* name, ImVec2 at, ImVec2 hold, float picture_width, float picture_height) {
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, hold);
  const float width = std::min(0.9f * picture_width, 460 * ui::scale());
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, picture_height});
  ImGui::SetNextWindowBgAlpha(0.88f);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
}

}  // namespace

void draw_notices(const Feedback& feedback, double now, float picture_width, float picture_height) {
  const std::vector<const Notice*> fresh = feedback.fresh(now);
  if (fresh.empty()) return;
  begin_box("notices", {0.5f * picture_width, picture_height - 12 * ui::scale()}, {0.5f, 1}, picture_width,
            picture_height);
  for (const Notice* n : fresh) {
    ui::mark(n->mark);
    ui::text(n->text, n->mark == Mark::note ? ui::kWhite : ui::colour_of(n->mark));
  }
  ImGui::End();
}

void draw_waiting(const std::string& why, const std::vector<std::string>& help, float picture_width,
                  float picture_height) {
  begin_box("waiting", {0.5f * picture_width, 0.4f * picture_height}, {0.5f, 0.5f}, picture_width, picture_height);
  ui::mark(Mark::warning);
  ui::text(tr("Paused: {}", why), ui::colour_of(Mark::warning));
  for (const std::string& line : help) ui::text(line, ui::kWhite);
  ImGui::End();
}

}  // namespace trocar::app
