#include "shell/gamepads.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/core/log.hpp>

namespace trocar::app {
namespace {

using devices::Button;
using devices::Gamepad;

constexpr const char* kButtonNames[] = {
    "a",     "b",          "x",           "y",  "left_shoulder", "right_shoulder", "back",
    "start", "left_stick", "right_stick", "up", "right",         "down",           "left"};
static_assert(std::size(kButtonNames) == std::size_t(Button::count));

constexpr int kGlfwButtons[] = {
    GLFW_GAMEPAD_BUTTON_A,           GLFW_GAMEPAD_BUTTON_B,           GLFW_GAMEPAD_BUTTON_X,
    GLFW_GAMEPAD_BUTTON_Y,           GLFW_GAMEPAD_BUTTON_LEFT_BUMPER, GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER,
    GLFW_GAMEPAD_BUTTON_BACK,        GLFW_GAMEPAD_BUTTON_START,       GLFW_GAMEPAD_BUTTON_LEFT_THUMB,
    GLFW_GAMEPAD_BUTTON_RIGHT_THUMB, GLFW_GAMEPAD_BUTTON_DPAD_UP,     GLFW_GAMEPAD_BUTTON_DPAD_RIGHT,
    GLFW_GAMEPAD_BUTTON_DPAD_DOWN,   GLFW_GAMEPAD_BUTTON_DPAD_LEFT};
static_assert(std::size(kGlfwButtons) == std::size_t(Button::count));

constexpr float kTouched = 0.25f;
constexpr std::size_t kLongestLine = 512;

Gamepad from_glfw(const GLFWgamepadstate& pad) {
  const auto trigger = [&pad](int axis) { return 0.5f * (pad.axes[axis] + 1); };  // GLFW: -1 released .. 1 pulled
  Gamepad g;
  g.left_x = pad.axes[GLFW_GAMEPAD_AXIS_LEFT_X];
  g.left_y = pad.axes[GLFW_GAMEPAD_AXIS_LEFT_Y];
  g.right_x = pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_X];
  g.right_y = pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y];
  g.left_trigger = trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER);
  g.right_trigger = trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER);
  for (std::size_t b = 0; b < std::size(kGlfwButtons); ++b)
    g.set(Button(b), pad.buttons[kGlfwButtons[b]] == GLFW_PRESS);
  return g;
}

}  // namespace

std::optional<Gamepad> read_gamepad_line(const std::string& line, bool& gone) {
  gone = false;
  std::istringstream words(line);
  words.imbue(std::locale::classic());
  Gamepad g;
  float* axes[] = {&g.left_x, &g.left_y, &g.right_x, &g.right_y, &g.left_trigger, &g.right_trigger};
  for (std::size_t i = 0; i < std::size(axes); ++i) {
    std::string word;
    if (!(words >> word)) return {};
    if (i == 0 && word == "gone") {
      gone = true;
      return {};
    }
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != 0 || !std::isfinite(value)) return {};
    *axes[i] = float(std::clamp(value, i < 4 ? -1.0 : 0.0, 1.0));
  }
  for (std::string word; words >> word;) {
    const auto found = std::find(std::begin(kButtonNames), std::end(kButtonNames), word);
    if (found == std::end(kButtonNames)) return {};
    g.set(Button(found - std::begin(kButtonNames)));
  }
  return g;
}

bool touched(const Gamepad& g) {
  return g.buttons != 0 || std::max({std::abs(g.left_x), std::abs(g.left_y), std::abs(g.right_x), std::abs(g.right_y),
                                     g.left_trigger, g.right_trigger}) > kTouched;
}

/// The file or pipe behind TROCAR_GAMEPAD.
class Gamepads::Seam {
 public:
  explicit Seam(const char* path) : m_file(open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (m_file < 0) core::log::warn("TROCAR_GAMEPAD: cannot read {}", path);
  }
  ~Seam() {
    if (m_file >= 0) close(m_file);
  }
  Seam(const Seam&) = delete;
  Seam& operator=(const Seam&) = delete;

  /// The next whole line, if there is one.
  std::optional<std::string> line() {
    const std::size_t end = m_text.find('\n');
    if (end == std::string::npos) {
      char bytes[4096];
      const ssize_t n = m_file < 0 || m_text.size() > kLongestLine ? 0 : read(m_file, bytes, sizeof bytes);
      if (n > 0) m_text.append(bytes, std::size_t(n));
      if (m_text.find('\n') == std::string::npos) {
        if (m_text.size() > kLongestLine) m_text.clear();
        return {};
      }
      return line();
    }
    std::string out = m_text.substr(0, end);
    m_text.erase(0, end + 1);
    return out;
  }

 private:
  int m_file = -1;
  std::string m_text;
};

Gamepads::Gamepads() {
  if (const char* path = std::getenv("TROCAR_GAMEPAD"); path && *path) m_seam = std::make_unique<Seam>(path);
}
Gamepads::~Gamepads() = default;

void Gamepads::poll() {
  m_lost = false;
  if (m_seam)
    poll_seam();
  else
    poll_glfw();
}

void Gamepads::poll_seam() {
  const std::optional<std::string> line = m_seam->line();
  if (!line) return;
  bool gone = false;
  const std::optional<Gamepad> sample = read_gamepad_line(*line, gone);
  if (gone) {
    m_lost = present();
    m_names.clear();
    m_state = {};
  } else if (sample) {
    m_names = {"gamepad of TROCAR_GAMEPAD"};
    m_state = *sample;
  }
}

void Gamepads::poll_glfw() {
  m_names.clear();
  Gamepad first, used;
  int first_id = -1, touched_id = -1;
  bool used_there = false;
  GLFWgamepadstate raw;
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    if (!glfwJoystickIsGamepad(id) || !glfwGetGamepadState(id, &raw)) continue;
    const char* name = glfwGetGamepadName(id);
    m_names.emplace_back(name ? name : "gamepad");
    const Gamepad pad = from_glfw(raw);
    if (first_id < 0) first_id = id, first = pad;
    if (id == m_used) used_there = true, used = pad;
    if (touched_id < 0 && id != m_used && touched(pad)) touched_id = id;
  }
  m_lost = m_used >= 0 && !used_there;
  if (touched_id >= 0 && !(used_there && touched(used))) {
    glfwGetGamepadState(touched_id, &raw);
    m_used = touched_id;
    m_state = from_glfw(raw);
  } else if (used_there) {
    m_state = used;
  } else {
    m_used = -1;
    m_state = {};  // not yet touched: nobody's
  }
  const char* guid = m_used >= 0 ? glfwGetJoystickGUID(m_used) : nullptr;
  m_guid = guid ? guid : "";
}

}  // namespace trocar::app
