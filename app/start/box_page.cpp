// The instrument box: hardware with encoders at real instruments. It is found, tried out and calibrated here.
#include <algorithm>
#include <filesystem>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/catalogue.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMonitorSeconds = "5";

std::string simulated_port() { return (attempt::data_folder() / "simulated-box").string(); }

/// Serial ports of this machine, and the simulated box where it runs.
std::vector<std::string> box_ports() {
  std::vector<std::string> ports;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator("/dev", error)) {
    const std::string name = file.path().filename().string();
    if (name.rfind("ttyUSB", 0) == 0 || name.rfind("ttyACM", 0) == 0) ports.push_back(file.path().string());
  }
  std::sort(ports.begin(), ports.end());
  if (fs::exists(simulated_port(), error)) ports.push_back(simulated_port());
  return ports;
}

void draw_simulated(const StartContent& c, const attempt::ExerciseEntry& exercise, StartMemory& memory,
                    StartAnswer& answer) {
  const char* title = tr("The simulated box");
  const bool runs = c.children.running(title);
  if (ui::button(tr("Start a simulated box"), {.width = 240, .height = 34, .enabled = !runs}))
    answer.program = {title, {"box", "simulate", simulated_port(), "--exercise", exercise.name, "--wave"}, {}, true};
  first_focus(memory);
  ImGui::SameLine();
  if (ui::button(tr("Stop it"), {.width = 110, .height = 34, .enabled = runs})) answer.stop = title;
  ui::text(tr("Software in place of hardware: its hands wave slowly. It shows that the program works without a box."),
           ui::kGrey);
}

void draw_port(const std::string& port, const std::string& person, const attempt::ExerciseEntry& exercise,
               StartAnswer& answer) {
  const std::string id = "##" + port;
  ui::text(port);
  if (ui::button(tr("Monitor") + id, {.width = 130, .height = 32}))
    answer.program = {tr("The monitor"), {"box", "monitor", port, "--seconds", kMonitorSeconds}, {}};
  ImGui::SameLine();
  if (ui::button(tr("Calibrate") + id, {.width = 130, .height = 32}))
    answer.program = {tr("The calibration"), {"box", "calibrate", port}, {}};
  ImGui::SameLine();
  if (ui::button(tr("Practise with it") + id, {.width = 170, .height = 32})) {
    answer.program = {tr("The exercise with the box"), {"train", exercise.name, "--input", "box:" + port}, {}};
    if (!person.empty()) answer.program.arguments.insert(answer.program.arguments.end(), {"--trainee", person});
  }
}

}  // namespace

void draw_box_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  ui::title(tr("Instrument box"));
  ui::text(tr("An instrument box is hardware: real instrument handles whose encoders report angle, depth, roll and "
              "opening over a serial port. Connect it, calibrate it once, then practise with it."),
           ui::kGrey);
  if (c.exercises.empty()) return;
  const int next = std::max(0, next_for(c.exercises, c.past.standings));
  const attempt::ExerciseEntry& exercise = c.exercises[std::size_t(memory.selected >= 0 ? memory.selected : next)];
  ui::text(tr("Exercise: {}", title_of(exercise)));
  draw_simulated(c, exercise, memory, answer);
  ui::heading(tr("Ports"));
  const std::vector<std::string> ports = box_ports();
  if (ports.empty()) ui::text(tr("No serial port found. Connect the box, or start a simulated one."), ui::kGrey);
  for (const std::string& port : ports) draw_port(port, c.person, exercise, answer);
  const std::string seen = c.children.output(tr("The monitor"));
  if (seen.empty()) return;
  ui::heading(tr("Measured"));
  ImGui::BeginChild("measured", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  ui::text(last_lines(seen, 30));
  ImGui::EndChild();
}

}  // namespace trocar::app
