#include "box/calibration_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/attempt/box/assistant.hpp>
#include <trocar/attempt/box/box_file.hpp>
#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/box/box_thread.hpp>

#include "shell/event_log.hpp"
#include "shell/open_window.hpp"
#include "shell/settings.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using attempt::BoxAssistant;
using attempt::BoxQuestion;
using devices::BoxTime;

constexpr double kDegrees = 57.29577951308232;
constexpr BoxTime kPatience = 1'500'000'000;  // for a line to say something, before the next one is tried [ns]
constexpr std::uint64_t kSound = 5;           // blocks, and a line is the right one
constexpr std::array<int, 6> kBauds = {38'400, 9'600, 19'200, 57'600, 115'200, 230'400};

/// What a box may speak, the likeliest first.
std::vector<devices::BoxWiring> lines_to_try(const CalibrationOptions& o) {
  std::vector<devices::BoxWiring> lines = {o.basis};
  if (o.settled) return lines;
  for (const int baud : kBauds)
    for (const bool raw : {false, true}) {
      if (baud == o.basis.baud && raw == o.basis.raw) continue;
      lines.push_back(o.basis);
      lines.back().baud = baud, lines.back().raw = raw;
    }
  return lines;
}

/// All channels go over the line: not more often than they fit.
devices::BoxWiring paced(devices::BoxWiring line) {
  const std::size_t bytes = line.raw ? devices::kRawBlockBytes : devices::data_size(devices::kAllBoxChannels);
  line.rate = std::min(line.rate, devices::most_blocks(bytes, line.baud));
  return line;
}

std::string line_in_words(const devices::BoxWiring& line) {
  return line.raw ? tr("raw blocks at {} Bd", line.baud) : tr("frames at {} Bd", line.baud);
}

Json question_json(const BoxQuestion& q) {
  constexpr std::array<const char*, 3> kKinds = {"sweep", "hold", "press"};
  return {{"kind", kKinds[std::size_t(q.kind)]},
          {"actor", devices::kBoxActorNames[std::size_t(q.actor)]},
          {"axis", devices::kBoxAxisNames[std::size_t(q.axis)]},
          {"value", q.value},
          {"pedal", q.pedal},
          {"button", q.button}};
}

class CalibrationWindow {
 public:
  CalibrationWindow(Window& window, const CalibrationOptions& options)
      : m_window(window), m_options(options), m_lines(lines_to_try(options)), m_log(EventLog::path_of(options.log)) {
    listen_at(0);
  }

  bool run() {
    while (!m_quit && !m_window.wants_to_close() && !attempt::interrupted()) picture();
    return m_written;
  }

 private:
  void listen_at(std::size_t line) {
    m_box.reset();
    m_line = line;
    m_box = std::make_unique<devices::BoxThread>(m_options.port, paced(m_lines[line]), devices::kAllBoxChannels);
    m_tried = devices::box_now();
    m_pose = {};
  }
  bool hears() const { return m_pose.number >= kSound; }
  void picture();
  void listen();
  void tell(const std::string& screen);
  void draw_search();
  void draw_parts();
  void draw_question();
  void draw_answers();
  void draw_values();
  void draw_channels(int found);
  void draw_found();
  void take();
  void save();

  Window& m_window;
  const CalibrationOptions& m_options;
  std::vector<devices::BoxWiring> m_lines;
  std::size_t m_line = 0;
  EventLog m_log;
  std::unique_ptr<devices::BoxThread> m_box;
  BoxTime m_tried = 0;  ///< since when this line is listened at
  devices::BoxPose m_pose;
  attempt::BoxParts m_parts;
  std::optional<BoxAssistant> m_assistant;
  std::string m_said;  ///< why the last answer was not taken
  std::string m_told;
  std::string m_saved;
  bool m_written = false, m_quit = false;
};

void CalibrationWindow::listen() {
  devices::BoxPose pose;
  if (m_box->take(pose)) {
    m_pose = pose;
    if (m_assistant) m_assistant->see(pose.block, pose.acquired);
  }
  const bool silent = !hears() && devices::box_now() > m_tried + kPatience;
  if (silent && m_lines.size() > 1) listen_at((m_line + 1) % m_lines.size());
}

/// For tests that drive the window.
void CalibrationWindow::tell(const std::string& screen) {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  if (!m_log.on() || (screen == "question" && m_assistant->done()))
    return;  // answered: the next picture shows what came
  Json places = Json::object();
  for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
  Json line{{"name", screen}, {"widgets", places}};
  if (screen == "question")
    line.update({{"question", question_json(m_assistant->question())}, {"number", m_assistant->number()}});
  if (std::string text = line.dump(); text != m_told) m_told = std::move(text), m_log.event("screen", line);
}

void CalibrationWindow::picture() {
  m_window.begin_picture();
  listen();
  ui::begin_screen("calibration");
  ui::title("Calibrate the instrument box");
  const std::string line = line_in_words(m_lines[m_line]);
  ui::text(hears() ? tr("{}: {}, {:.0f} blocks a second", m_options.port, line, m_box->status().rate)
                   : fmt::format("{}: {}", m_options.port, line),
           ui::kGrey);
  ImGui::Separator();
  std::string screen = "search";
  if (!hears()) {
    draw_search();
  } else if (!m_assistant) {
    screen = "parts";
    draw_parts();
  } else if (!m_assistant->done()) {
    screen = "question";
    draw_question();
  } else {
    screen = "found";
    draw_found();
  }
  ImGui::End();
  m_window.draw_panels();
  tell(screen);
  m_window.show();
}

void CalibrationWindow::draw_search() {
  ui::text(m_box->status().open ? "The port is open, and nothing comes. Is the box switched on?"
                                : "The port cannot be opened yet. Is the box plugged in?");
  if (m_lines.size() > 1)
    ui::text(tr("Trying what boxes speak, one after the other: {} of {}.", m_line + 1, m_lines.size()));
  else
    ui::text("Only this line is tried, as --raw, --framed or --baud said.");
  if (ui::button("Quit", {.width = 130})) m_quit = true;
}

void CalibrationWindow::draw_parts() {
  ui::text("What does the box have? Each of these is asked about; what turns out not to be there can be skipped.");
  constexpr std::array<const char*, devices::kBoxActors> kNames = {
      "left instrument", "right instrument", "a third instrument", "a fourth instrument", "endoscope"};
  for (std::size_t a = 0; a < m_parts.actors.size(); ++a) ui::checkbox(kNames[a], m_parts.actors[a]);
  ui::checkbox("switches and valves on the instruments", m_parts.buttons);
  ui::checkbox("foot switches", m_parts.pedals);
  ImGui::Dummy({0, 6 * ui::scale()});
  const BoxAssistant outlook(m_lines[m_line], m_parts);
  ui::text(tr("{} questions, about {:.0f} minutes. A protractor and a ruler at the trocars make it exact.",
              outlook.count(), std::max(1.0, std::round(double(outlook.count()) / 8))),
           ui::kGrey);
  if (ui::button("Begin", {.width = 200, .height = 40, .primary = true, .enabled = m_parts.any()}))
    m_assistant.emplace(m_lines[m_line], m_parts);
  ImGui::SameLine();
  if (ui::button("Quit", {.width = 130, .height = 40})) m_quit = true;
  draw_channels(-1);
}

void CalibrationWindow::take() {
  m_said = m_assistant->take();
  m_log.event("answer", {{"taken", m_said.empty()}, {"why_not", m_said}, {"number", m_assistant->number()}});
}

void CalibrationWindow::draw_question() {
  const BoxQuestion q = m_assistant->question();
  ImGui::ProgressBar(float(m_assistant->number()) / float(m_assistant->count()), {-1, 6 * ui::scale()}, "");
  ui::heading(fmt::format("{} of {}", m_assistant->number() + 1, m_assistant->count()));
  ui::text(q.heading, ui::kBlue);
  ui::title(q.text);
  const std::string why = m_assistant->why_not();
  ui::mark(why.empty() ? ui::Mark::done : ui::Mark::open);
  ui::text(!why.empty() ? why
           : q.kind == BoxQuestion::Kind::sweep
               ? tr("channel {}, moved by {:.0f} codes", m_assistant->found(), m_assistant->moved())
           : q.kind == BoxQuestion::Kind::hold ? tr("still, within {:.0f} codes", m_assistant->moved())
                                               : fmt::format("bit {}", m_assistant->found()),
           why.empty() ? ui::kWhite : ui::kGrey);
  if (q.kind == BoxQuestion::Kind::hold) draw_values();
  draw_answers();
  if (!m_said.empty()) {
    ui::mark(ui::Mark::warning);
    ui::text("Not taken: " + m_said, ui::kOrange);
  }
  draw_channels(m_assistant->done() ? -1 : m_assistant->found());
}

/// Another angle than the one that was proposed, and more of them.
void CalibrationWindow::draw_values() {
  const BoxQuestion q = m_assistant->question();
  const bool share = q.axis == devices::BoxAxis::handle && q.actor != devices::BoxActor::scope;
  const double unit = q.axis == devices::BoxAxis::depth ? 0.001 : share ? 0.01 : 1 / kDegrees;
  const double step = (q.axis == devices::BoxAxis::depth ? 10 : share ? 10 : 5) * unit;
  const double bounds[] = {share || q.axis == devices::BoxAxis::depth ? 0.0 : -180 * unit,
                           q.axis == devices::BoxAxis::depth ? 0.4
                           : share                           ? 1.0
                                                             : 180 * unit};
  const auto change = [&](double by) {
    m_assistant->set_value(std::clamp(std::round((q.value + by) / unit) * unit, bounds[0], bounds[1]));
  };
  if (ui::button("Less", {.width = 80})) change(-step);
  ImGui::SameLine();
  if (ui::button("More", {.width = 80})) change(step);
  ImGui::SameLine();
  if (ui::button("A little more", {.width = 130})) change(unit);
  ImGui::SameLine();
  if (ui::button("One row more", {.width = 140, .tip = "this axis is asked once more, at a value of your choice"}))
    m_assistant->add_row(std::clamp(q.value + step, bounds[0], bounds[1]));
}

void CalibrationWindow::draw_answers() {
  const BoxQuestion::Kind kind = m_assistant->question().kind;
  const auto pressed = [this](int key) {
    return std::any_of(m_window.typed().begin(), m_window.typed().end(),
                       [key](const TypedKey& k) { return k.key == key; });
  };
  // A switch that was pressed and let go has answered by itself.
  const bool by_itself = kind == BoxQuestion::Kind::press && m_assistant->ready();
  if (ui::button("Take it (space)", {.width = 200, .height = 40, .primary = true}) || pressed(GLFW_KEY_SPACE) ||
      by_itself)
    return take();
  ImGui::SameLine();
  if (ui::button("There is none (S)", {.width = 180, .height = 40}) || pressed(GLFW_KEY_S)) {
    m_said.clear();
    return m_assistant->skip();
  }
  ImGui::SameLine();
  if (ui::button("Back (backspace)", {.width = 180, .height = 40, .enabled = m_assistant->can_go_back()}) ||
      pressed(GLFW_KEY_BACKSPACE)) {
    m_said.clear();
    m_assistant->back();
  }
}

/// All channels as bars, those that have an axis in blue; the one that is meant stands out. One can be chosen.
void CalibrationWindow::draw_channels(int found) {
  ui::heading("channels");
  const bool bits = m_assistant && !m_assistant->done() && m_assistant->question().kind == BoxQuestion::Kind::press;
  const bool looks = m_assistant && !m_assistant->done() && m_assistant->question().kind == BoxQuestion::Kind::sweep;
  const devices::ChannelMask taken = m_assistant ? m_assistant->wiring().mask() : 0;
  const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float height = std::clamp(room.y - 70 * ui::scale(), 40 * ui::scale(), 160 * ui::scale());
  const float pitch = room.x / float(devices::kBoxChannels);
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (int c = 0; c < devices::kBoxChannels; ++c) {
    const float x = corner.x + pitch * float(c), width = 0.7f * pitch;
    const float share = float(m_pose.block.codes[std::size_t(c)]) / float(devices::kBoxTopCode);
    const ImVec4 colour = c == found && !bits ? ui::kOrange : (taken >> c & 1) != 0 ? ui::kBlue : ui::kGrey;
    list->AddRectFilled({x, corner.y}, {x + width, corner.y + height}, ImGui::GetColorU32({1, 1, 1, 0.06f}));
    list->AddRectFilled({x, corner.y + height * (1 - share)}, {x + width, corner.y + height},
                        ImGui::GetColorU32(colour));
    ImGui::SetCursorScreenPos({x, corner.y});
    if (ImGui::InvisibleButton(fmt::format("channel {}", c).c_str(), {width, height}) && looks)
      m_said = m_assistant->choose(c);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("channel %d: %d%s", c, int(m_pose.block.codes[std::size_t(c)]),
                        looks ? "; click: it is this one" : "");
  }
  ImGui::SetCursorScreenPos({corner.x, corner.y + height + 8 * ui::scale()});
  for (int bit = 0; bit < devices::kBoxDigitalBits; ++bit) {
    const float size = 12 * ui::scale(), x = corner.x + 1.5f * size * float(bit);
    const float y = ImGui::GetCursorScreenPos().y;
    const bool on = (m_pose.block.digital >> bit & 1) != 0;
    const ImU32 colour = ImGui::GetColorU32(bits && bit == found ? ui::kOrange : on ? ui::kWhite : ui::kGrey);
    if (on)
      list->AddRectFilled({x, y}, {x + size, y + size}, colour);
    else
      list->AddRect({x, y}, {x + size, y + size}, colour);
  }
  ImGui::Dummy({0, 14 * ui::scale()});
  ui::text("above: channels 0 to 47, below: bits 0 to 31 as they come", ui::kGrey);
}

/// Everything that was found, and what the hands do now by it.
void CalibrationWindow::draw_found() {
  const devices::BoxWiring& wiring = m_assistant->wiring();
  ui::text("That was all. Move everything once more: these are the figures by the new tables.", ui::kWhite);
  if (ImGui::BeginTable("figures", 1 + devices::kBoxAxes, ImGuiTableFlags_RowBg)) {
    for (int actor = 0; actor < devices::kBoxActors; ++actor) {
      if (!wiring.has(devices::BoxActor(actor))) continue;
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ui::text(devices::kBoxActorNames[std::size_t(actor)], ui::kBlue);
      for (int which = 0; which < devices::kBoxAxes; ++which) {
        ImGui::TableNextColumn();
        const devices::WiredAxis& axis = wiring.axis(devices::BoxActor(actor), devices::BoxAxis(which));
        if (axis.channel < 0 || axis.table.codes.size() < 2) {
          ui::text("-", ui::kGrey);
          continue;
        }
        const double value = axis.table.value(double(m_pose.block.codes[std::size_t(axis.channel)]));
        const bool angle = devices::BoxAxis(which) != devices::BoxAxis::depth &&
                           (devices::BoxAxis(which) != devices::BoxAxis::handle ||
                            devices::BoxActor(actor) == devices::BoxActor::scope);
        ui::text(fmt::format("{}: {}", devices::kBoxAxisNames[std::size_t(which)],
                             angle ? fmt::format("{:.1f} deg", value * kDegrees)
                             : devices::BoxAxis(which) == devices::BoxAxis::depth
                                 ? fmt::format("{:.1f} mm", 1000 * value)
                                 : fmt::format("{:.2f}", value)));
      }
    }
    ImGui::EndTable();
  }
  ImGui::Dummy({0, 6 * ui::scale()});
  if (ui::button("Save", {.width = 200, .height = 40, .primary = true})) save();
  ImGui::SameLine();
  if (ui::button("Back (backspace)", {.width = 180, .height = 40})) m_assistant->back();
  ImGui::SameLine();
  if (ui::button(m_written ? "Done" : "Quit", {.width = 130, .height = 40})) m_quit = true;
  ui::text(m_saved.empty() ? "It goes to " + m_options.output.generic_string() : m_saved, ui::kGrey);
  draw_channels(-1);
}

/// The old file stays beside the new one.
void CalibrationWindow::save() {
  std::error_code error;
  std::filesystem::path before = m_options.output;
  before += ".before";
  if (std::filesystem::exists(m_options.output, error)) {
    std::filesystem::rename(m_options.output, before, error);
    m_saved = error ? "" : tr("The earlier file is now {}. ", before.generic_string());
  }
  if (m_options.output.has_parent_path()) std::filesystem::create_directories(m_options.output.parent_path(), error);
  const std::string text = attempt::box_file_text(m_assistant->wiring());
  const std::string fault = core::write_file(m_options.output, text.data(), text.size(), 0600);
  m_written = fault.empty();
  m_saved += m_written ? tr("Saved: {}", m_options.output.generic_string())
                       : tr("Cannot write {}: {}", m_options.output.generic_string(), fault);
  m_log.event("saved", {{"file", m_options.output.generic_string()}, {"written", m_written}});
}

}  // namespace

bool calibrate_in_window(const CalibrationOptions& options) {
  std::vector<core::Fault> ignored;
  const Settings settings = read_settings(settings_file(), ignored);
  Window window = open_window(
      "Trocar: instrument box", {1000, 700},
      "Without a window: trocar box monitor PORT shows all channels, trocar box file the file to be filled in");
  window.set_text_size(settings.text_size);
  return CalibrationWindow(window, options).run();
}

}  // namespace trocar::app
