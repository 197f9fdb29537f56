#include "trainer/panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>

#include "shell/ui.hpp"
#include "trainer/generator.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

constexpr float kNarrowest = 250, kWidest = 340, kShare = 0.27f;

std::string clock_text(double seconds) {
  const int whole = int(std::max(0.0, seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

void draw_time(const PanelContent& c) {
  ui::title(clock_text(c.now.seconds));
  ImGui::SameLine(0, 10 * ui::scale());
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 6 * ui::scale());
  if (c.paused)
    ui::text("paused", ui::kOrange);
  else if (c.now.speed < 0.97)
    ui::text(fmt::format("slow motion x{:.2f}", c.now.speed), ui::kOrange);
  else
    ui::text(c.mode.empty() ? c.trainee : c.mode, ui::kGrey);
}

/// The step that is to be done now, in a box that is seen first.
void draw_now(const PanelContent& c) {
  if (c.steps.empty()) return ui::text("Free practice: no task, no score.", ui::kGrey);
  const float width = ImGui::GetContentRegionAvail().x, pad = 8 * ui::scale();
  const bool over = c.now.current_step >= int(c.steps.size());
  const std::string name = over ? "All steps done" : c.steps[size_t(c.now.current_step)].name;
  const std::string hint = over ? "" : c.steps[size_t(c.now.current_step)].hint;
  const float wrap = width - 2 * pad;
  const float gap = ImGui::GetStyle().ItemSpacing.y, line = ImGui::GetTextLineHeight();
  const float height = 2 * pad + line + gap +
                       ImGui::CalcTextSize(ui::wrapped(name, wrap - 22 * ui::scale()).c_str()).y +
                       (hint.empty() ? 0 : gap + ImGui::CalcTextSize(ui::wrapped(hint, wrap).c_str()).y);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, {0.08f, 0.22f, 0.34f, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad});
  ImGui::BeginChild("now", {width, height}, false,
                    ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysUseWindowPadding |
                        ImGuiWindowFlags_NoScrollbar);
  ui::text(over ? "Well done" : fmt::format("Now: step {} of {}", c.now.current_step + 1, c.steps.size()), ui::kBlue);
  ui::mark(over ? Mark::done : Mark::now);
  ui::text(name);
  if (!hint.empty()) ui::text(hint, {0.82f, 0.86f, 0.90f, 1});
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

/// Is hand `h` led just now, alone or as one of two?
bool leads(const PanelContent& c, int h) {
  if (!c.hands) return false;
  if (!c.both) return c.hands->led == h;
  return !c.both->looking && (c.both->pair[devices::kLeft] == h || c.both->pair[devices::kRight] == h);
}

/// What leads this side of both.
const char* leader_of(const PanelContent& c, int side) {
  if (c.gamepad) return side == devices::kLeft ? "left stick" : "right stick";
  return side == c.both->mouse ? "mouse" : "keys";
}

/// Costs no line of its own: the panel is full.
std::string hands_heading(const PanelContent& c) {
  if (!c.both) return "Hands";
  const auto of = [&](int side) { return fmt::format("{} {}", c.both->pair[size_t(side)] + 1, leader_of(c, side)); };
  return fmt::format("Both: {}, {}", of(devices::kLeft), of(devices::kRight));
}

void draw_hand(const PanelContent& c, int h) {
  const interactions::ToolState& tool = c.now.state.tools[size_t(h)];
  const interactions::ToolModel& held = attempt::held_by(c.lesson.model, c.now.state, h);
  const bool led = leads(c, h);
  std::string about = attempt::in_words(held.name);
  if (held.clips > 0) about += fmt::format(", {} clips", tool.clips_left);
  std::string state;
  if (tool.holds > 0) state = "holds";
  if (c.hands && c.hands->ratchet[size_t(h)]) state += state.empty() ? "locked" : ", locked";
  if (const std::string flow = attempt::flow_in_words(c.now.state, h); !flow.empty()) state = flow;
  ui::mark(led ? Mark::now : Mark::note);
  const std::string where = attempt::hand_name(c.lesson.model, h);
  const std::string what =
      fmt::format("{} {}", h + 1, where == attempt::in_words(held.name) ? about : where + ": " + about);
  const float gap = 8 * ui::scale(), room = ImGui::GetContentRegionAvail().x;
  const bool beside = ImGui::CalcTextSize((what + state).c_str()).x + gap < room;
  const float indent = ImGui::GetCursorPosX();
  ui::text(what, led ? ui::kWhite : ui::kGrey);
  if (state.empty()) return;
  if (beside)
    ImGui::SameLine(0, gap);
  else
    ImGui::SetCursorPosX(indent);
  ui::text(state, ui::kBlue);
}

/// A clip wants to be closed slowly, and no device does so unasked.
void draw_slowly(const PanelContent& c, int h) {
  if (!leads(c, h) || attempt::held_by(c.lesson.model, c.now.state, h).clips == 0) return;
  ui::text(c.hands->fine ? "fine motion is on: the jaws close slowly"
           : c.gamepad   ? "close slowly: press the left stick, then pull"
                         : "close slowly: hold Shift, too",
           ui::kOrange);
}

const char* valves_of(const PanelContent& c, int h) {
  if (!c.both)
    return c.gamepad ? "right trigger: suction, left trigger: water" : "D or left button: suction, A or right: water";
  const int side = c.both->pair[devices::kLeft] == h ? devices::kLeft : devices::kRight;
  if (c.gamepad)
    return side == devices::kLeft ? "left trigger: suction, cross left: water"
                                  : "right trigger: suction, cross right: water";
  return side == c.both->mouse ? "left button: suction, right: water" : "D: suction, A: water";
}

const char* switches_of(const PanelContent& c, int h) {
  if (!c.both) return c.gamepad ? "right trigger: coagulate, left: cut" : "G or left button: coagulate, Space: cut";
  const int side = c.both->pair[devices::kLeft] == h ? devices::kLeft : devices::kRight;
  if (c.gamepad)
    return side == devices::kLeft ? "left trigger: coagulate, cross left: cut"
                                  : "right trigger: coagulate, cross right: cut";
  return side == c.both->mouse ? "left button: coagulate, N: cut" : "G: coagulate, Space: cut";
}

/// Two buttons that no other instrument has.
void draw_buttons(const PanelContent& c, int h) {
  if (!leads(c, h)) return;
  if (attempt::has_valves(c.lesson.model, c.now.state, h)) ui::text(valves_of(c, h), ui::kOrange);
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

/// A fogged lens, and the key that has it wiped, for whoever leads by hand.
void draw_lens(const PanelContent& c) {
  const std::string lens = attempt::lens_in_words(c.lesson.model, c.now.state);
  if (lens.empty()) return;
  const bool hint = c.hands && !(c.now.state.fluids.smoke.wipe_left > 0);
  ui::text(!hint ? lens : lens + (c.gamepad ? ": B wipes it" : ": T wipes it"), ui::kOrange);
}

void draw_hands(const PanelContent& c) {
  for (int h = 0; h < attempt::hand_count(c.lesson.model); ++h) {
    draw_hand(c, h);
    draw_slowly(c, h);
    draw_buttons(c, h);
  }
  if (!c.hands) return ui::text("led by " + c.input, ui::kGrey);
  const bool scope = c.both ? c.both->looking : c.hands->led == devices::kScope;
  ui::mark(scope ? Mark::now : Mark::note);
  ui::text("0 endoscope", scope ? ui::kWhite : ui::kGrey);
}

/// What an act would be worth if it were done now: depth and angle are hard to judge in a flat picture at first.
void draw_outlook(const PanelContent& c) {
  if (!c.outlook) return;
  ui::heading("If you close now");
  if (!c.outlook->on.empty()) ui::text("between the jaws: " + attempt::in_words(c.outlook->on), ui::kGrey);
  for (const training::Foretold::Finding& f : c.outlook->findings) {
    ui::mark(f.fits ? Mark::done : Mark::warning);
    ui::text(f.text, f.fits ? ui::kWhite : ui::kOrange);
  }
}

/// The hardest pull of all hands, and the hardest push at a trocar; the limit of the pull is a line in the bar, what is
/// beyond it is hatched by a word as well.
void draw_pull(const PanelContent& c) {
  double pull = 0, push = 0;
  for (int h = 0; h < attempt::hand_count(c.lesson.model); ++h) {
    pull = std::max(pull, attempt::pull_on(c.now.state, h));
    push = std::max(push, attempt::push_at_trocar(c.lesson.model, c.now.state, h));
  }
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
  const std::string label = fmt::format("pull {:.1f} N{}", pull, over ? "  TOO HARD" : near ? "  careful" : "");
  draw.AddText({at.x + 6 * ui::scale(), at.y + 0.5f * (height - ImGui::GetTextLineHeight())},
               ImGui::GetColorU32(over || near ? ImVec4{0, 0, 0, 1} : ui::kWhite), label.c_str());
  ImGui::Dummy({width, height});
  ui::text(fmt::format("{:.1f} N at the trocar", push), ui::kGrey);
}

void draw_generator(const PanelContent& c) {
  for (const GeneratorLine& line : generator_lines(c.lesson.model, c.now.state))
    ui::text(line.text, line.warning ? ui::kRed : line.on ? ui::kOrange : ui::kGrey);
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

}  // namespace

float panel_width(float width, float scale) {
  return std::min(0.5f * width, std::clamp(kShare * width, kNarrowest * scale, kWidest * scale));
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
  draw_patient(c);
  draw_fluids(c);
  draw_lens(c);
  draw_generator(c);
  draw_outlook(c);
  const float line = ImGui::GetTextLineHeightWithSpacing(), foot = line + 2 * ui::scale();
  ui::heading("Steps");
  const float left_over = ImGui::GetContentRegionAvail().y - foot - 1.9f * line;
  const float wanted = line * float(c.steps.size()) + 4 * ui::scale();
  const float steps = std::max(2 * line, std::min(wanted, 0.55f * left_over));
  draw_steps(c, steps);
  ui::heading("What happened");
  draw_list(c.feedback, std::max(line, ImGui::GetContentRegionAvail().y - foot));
  ui::text(c.gamepad ? "Y choose   Start pause   Back help" : "X choose   P pause   F1 help", ui::kGrey);
  ImGui::End();
}

void draw_notices(const Feedback& feedback, double now, float picture_width, float picture_height) {
  const std::vector<const Notice*> fresh = feedback.fresh(now);
  if (fresh.empty()) return;
  ImGui::SetNextWindowPos({0.5f * picture_width, picture_height - 12 * ui::scale()}, ImGuiCond_Always, {0.5f, 1});
  const float width = std::min(0.9f * picture_width, 460 * ui::scale());
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, picture_height});
  ImGui::SetNextWindowBgAlpha(0.88f);
  ImGui::Begin("notices", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  for (const Notice* n : fresh) {
    ui::mark(n->mark);
    ui::text(n->text, n->mark == Mark::note ? ui::kWhite : ui::colour_of(n->mark));
  }
  ImGui::End();
}

// --- help and hint ---

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

// --- rack ---

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
  ui::text(fmt::format("{} {:.0f} W", name, watts), ui::kWhite);
  ImGui::PopID();
  return keys;
}

std::uint32_t draw_panel_keys(const tissue::GeneratorPanel& p) {
  const bool cut = p.yellow == tissue::EnergyMode::cut;
  ui::text("What is the generator set to?", ui::kGrey);
  std::uint32_t keys =
      draw_setting(cut ? "yellow, cut" : "yellow, blend", p.yellow_watts, tissue::kYellowLess, tissue::kYellowMore);
  ImGui::SameLine();
  if (ui::button(cut ? "to blend" : "to cut")) keys |= tissue::kOtherCut;
  keys |= draw_setting("blue, coagulation", p.blue_watts, tissue::kBlueLess, tissue::kBlueMore);
  keys |= draw_setting("blue, bipolar", p.bipolar_watts, tissue::kBipolarLess, tissue::kBipolarMore);
  return keys;
}

/// One hand, or both; of both: what the mouse leads.
void draw_mode(const sim::Model& model, const devices::BothHands& both, RackChoice& choice) {
  if (attempt::hand_count(model) < 2) return;
  if (ui::button(both.on ? "both hands: on (H)" : "both hands: off (H)")) choice.both = true;
  ImGui::SameLine();
  if (!both.on) return;
  if (ui::button(fmt::format("mouse: hand {} (Tab)", both.pair[size_t(both.mouse)] + 1))) choice.exchange = true;
  ImGui::SameLine();
}

std::string rack_question(const sim::Model& model, const devices::BothHands& both) {
  const int count = attempt::hand_count(model);
  if (!both.on || count < 2) return "Time goes on. Which hand do you lead?";
  return fmt::format("Time goes on. You lead hands {} and {}. Which of them do you mean?{}", both.pair[0] + 1,
                     both.pair[1] + 1, count > 2 ? " A third one takes its place." : "");
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
    const std::string name = scope ? "0 endoscope" : fmt::format("{} {}", h + 1, attempt::hand_name(model, h));
    if (ui::button(name, {.primary = hands.led == hand})) choice.hand = hand;
    if (!scope) ImGui::SameLine();
  }
  if (hands.led != devices::kScope) {
    const std::vector<attempt::Choosable> list = attempt::choosable(model, state, hands.led);
    ui::text(fmt::format("What does it hold?"), ui::kGrey);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i > 0) ImGui::SameLine();
      if (ui::button(list[i].name, {.primary = list[i].held})) choice.instrument = list[i].index;
      if (list[i].held) ImGui::SetItemDefaultFocus();
    }
  }
  if (model.energy.there) choice.panel_keys = draw_panel_keys(state.panel);
  ui::text("And", ui::kGrey);
  if (hands.led != devices::kScope) {
    if (ui::button("into view (V)")) choice.insert = true;
    ImGui::SameLine();
    if (ui::button(hands.ratchet[size_t(hands.led)] ? "unlock jaws (Space)" : "lock jaws (Space)"))
      choice.ratchet = true;
    ImGui::SameLine();
  }
  if (ui::button(hands.fine ? "fine motion: on" : "fine motion: off")) choice.fine = true;
  draw_mode(model, both, choice);
  if (ui::button("pause (P)")) choice.pause = true;
  ImGui::SameLine();
  if (ui::button("go on (Esc)")) choice.close = true;
  ImGui::End();
  return choice;
}

// --- pause and result ---

namespace {

bool wide_button(const char* text, bool primary = false) {
  return ui::button(text, {.width = 260, .height = 32, .primary = primary});
}

}  // namespace

Choice draw_pause(const std::string& why, const std::string& recording, bool scored, bool display) {
  Choice choice = Choice::none;
  ui::begin_middle("pause", 520);
  ui::title("Paused");
  if (!why.empty()) {
    ui::mark(Mark::warning);
    ui::text(why, ui::kOrange);
  }
  ui::text("Time stands still.", ui::kGrey);
  if (wide_button("Go on", true)) choice = Choice::resume;
  ImGui::SetItemDefaultFocus();
  if (wide_button("Finish now")) choice = Choice::finish;
  ImGui::SameLine();
  ui::text(scored ? "ends and shows the result" : "ends", ui::kGrey);
  if (wide_button("Begin again")) choice = Choice::restart;
  if (wide_button("Keys and buttons")) choice = Choice::help;
  if (wide_button("Settings")) choice = Choice::settings;
  if (display && wide_button("Display")) choice = Choice::display;
  if (display && wide_button("Views")) choice = Choice::views;
  if (wide_button("To the start screen")) choice = Choice::start_screen;
  if (wide_button("Quit Trocar")) choice = Choice::quit;
  if (!recording.empty()) ui::text("recorded in " + recording, ui::kGrey);
  ImGui::End();
  return choice;
}

namespace {

void result_line(const Json& from, const char* key, const char* text, const char* format, double factor = 1) {
  if (!from.contains(key) || !from[key].is_number()) return;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ui::text(text, ui::kGrey);
  ImGui::TableNextColumn();
  ui::text(fmt::format(fmt::runtime(format), factor * from[key].get<double>()));
}

void draw_errors(const Json& errors) {
  ui::heading(errors.empty() ? "No errors" : "Errors");
  for (const Json& e : errors) {
    ui::mark(e.value("fail", false) ? Mark::error : Mark::warning);
    ui::text(fmt::format("{}  {}{}", clock_text(e.value("at_s", e.value("at", 0.0))), e.value("meaning", std::string()),
                         e.contains("points") && e["points"].get<double>() > 0
                             ? fmt::format("  (-{:.0f})", e["points"].get<double>())
                             : std::string()));
  }
}

void draw_assessment(const Json& a) {
  if (ImGui::BeginTable("score", 2)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 0.3f);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.7f);
    if (a.contains("score") && a["score"].is_object())
      for (const auto& [key, value] : a["score"].items())
        result_line(a["score"], key.c_str(), attempt::in_words(key).c_str(),
                    key == "total" ? "{:.0f} of 100" : "{:.2f}");
    result_line(a, "exercise_seconds", "time", "{:.0f} s");
    ImGui::EndTable();
  }
  if (a.contains("steps")) {
    ui::heading("Steps");
    for (const Json& s : a["steps"]) {
      const bool done = s.value("done", false);
      ui::mark(done ? Mark::done : Mark::open);
      ui::text(s.value("name", std::string()) + (done ? "" : "  (not done)"), done ? ui::kWhite : ui::kGrey);
    }
  }
  if (a.contains("errors")) draw_errors(a["errors"]);
}

void draw_verdict(const Json& r, const std::string& mode) {
  if (r.contains("failure")) return ui::title("The simulation failed", ui::kRed);
  if (!mode.empty() || r["passed"].is_null()) return ui::title("The end");
  const bool passed = r["passed"].get<bool>();
  if (r.contains("interrupted")) return ui::title("Ended early", ui::kOrange);
  ui::mark(passed ? Mark::done : Mark::warning);
  ui::title(passed ? "Passed" : "Not passed yet", passed ? ui::kBlue : ui::kOrange);
}

}  // namespace

Choice draw_result(const Json& r, const std::string& mode, bool report, const std::string& say) {
  Choice choice = Choice::none;
  ui::begin_middle("result", 680);
  draw_verdict(r, mode);
  if (!mode.empty()) ui::text(mode, ui::kGrey);
  if (r.contains("failure")) ui::text(r["failure"].get<std::string>(), ui::kRed);
  const float most = 0.97f * ImGui::GetIO().DisplaySize.y - 190 * ui::scale();
  ImGui::BeginChild("details", {0, std::clamp(most, 60 * ui::scale(), 380 * ui::scale())}, false);
  if (r.contains("assessment")) draw_assessment(r["assessment"]);
  ui::heading("Ways of the tips");
  for (const Json& hand : r["metrics"]["hands"])  // the same figures as in the report: without the hand's tremor
    if (hand["path_m"].is_number())
      ui::text(fmt::format("{}: {:.0f} mm", attempt::in_words(hand["name"].get<std::string>()),
                           1000 * hand["path_m"].get<double>()),
               ui::kGrey);
  if (r.contains("recording")) ui::text("recorded in " + r["recording"].get<std::string>(), ui::kGrey);
  ImGui::EndChild();
  if (!say.empty()) ui::text(say, ui::kGrey);
  if (ui::button("Again", {.width = 140, .height = 32, .primary = true})) choice = Choice::restart;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (report) {
    if (ui::button("Open the report", {.width = 160, .height = 32})) choice = Choice::report;
    ImGui::SameLine();
  }
  if (ui::button("Start screen", {.width = 140, .height = 32})) choice = Choice::start_screen;
  ImGui::SameLine();
  if (ui::button("Quit", {.width = 90, .height = 32})) choice = Choice::quit;
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
