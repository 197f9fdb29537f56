#include "shell/gamepads.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/core/log.hpp>

namespace trocar::app {
namespace {

using devices::Button;
using devices::Gamepad;

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
    const std::vector<std::string>& names = devices::button_names();
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) return {};
    g.set(Button(found - names.begin()));
  }
  return g;
}

bool touched(const Gamepad& g) {
  return g.buttons != 0 || std::max({std::abs(g.left_x), std::abs(g.left_y), std::abs(g.right_x), std::abs(g.right_y),
                                     g.left_trigger, g.right_trigger}) > kTouched;
}

/// A file or pipe of TROCAR_GAMEPAD.
class Gamepads::Seam {
 public:
  explicit Seam(const std::string& path) : m_file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (m_file < 0) core::log::warn("TROCAR_GAMEPAD: cannot read {}", path);
  }
  ~Seam() {
    if (m_file >= 0) close(m_file);
  }
  Seam(Seam&& other) noexcept
      : m_file(std::exchange(other.m_file, -1)), m_text(std::move(other.m_text)), m_pad(std::move(other.m_pad)) {}
  Seam& operator=(Seam&&) = delete;

  /// What its pad does after the next line, if there is one; nothing: it is unplugged.
  const std::optional<Gamepad>& poll() {
    const std::optional<std::string> text = line();
    if (!text) return m_pad;
    bool gone = false;
    const std::optional<Gamepad> sample = read_gamepad_line(*text, gone);
    if (sample || gone) m_pad = sample;
    return m_pad;
  }

 private:
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

  int m_file = -1;
  std::string m_text;
  std::optional<Gamepad> m_pad;
};

Gamepads::Gamepads() {
  const char* given = std::getenv("TROCAR_GAMEPAD");
  if (!given || !*given) return;
  std::istringstream paths(given);
  for (std::string path; std::getline(paths, path, ',');) m_seams.emplace_back(path);
}
Gamepads::~Gamepads() = default;

void Gamepads::poll() {
  m_all.clear();
  m_numbers.clear();
  if (!m_seams.empty())
    poll_seams();
  else
    poll_glfw();
  choose_used();
}

void Gamepads::poll_seams() {
  for (std::size_t i = 0; i < m_seams.size(); ++i) {
    const std::optional<Gamepad>& pad = m_seams[i].poll();
    if (!pad) continue;
    m_all.push_back({"gamepad of TROCAR_GAMEPAD", true, *pad, {}, {}});
    m_numbers.push_back(int(i));
  }
}

void Gamepads::poll_glfw() {
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    if (!glfwJoystickPresent(id)) continue;
    devices::DeviceReading reading;
    GLFWgamepadstate raw;
    reading.is_pad = glfwJoystickIsGamepad(id) && glfwGetGamepadState(id, &raw);
    const char* name = reading.is_pad ? glfwGetGamepadName(id) : glfwGetJoystickName(id);
    reading.name = name ? name : "gamepad";
    if (reading.is_pad) reading.pad = from_glfw(raw);
    int count = 0;
    if (const float* axes = glfwGetJoystickAxes(id, &count)) reading.axes.assign(axes, axes + count);
    if (const unsigned char* buttons = glfwGetJoystickButtons(id, &count))
      reading.buttons.assign(buttons, buttons + count);
    m_all.push_back(std::move(reading));
    m_numbers.push_back(id);
  }
}

/// Of the pads without a part the one last touched.
void Gamepads::choose_used() {
  m_names.clear();
  const Gamepad *used = nullptr, *other = nullptr;
  int other_number = -1;
  for (std::size_t i = 0; i < m_all.size(); ++i) {
    const devices::DeviceReading& reading = m_all[i];
    if (!reading.is_pad || (m_claimed && m_claimed(reading))) continue;
    m_names.push_back(reading.name);
    if (m_numbers[i] == m_used) used = &reading.pad;
    if (!other && m_numbers[i] != m_used && touched(reading.pad)) other = &reading.pad, other_number = m_numbers[i];
  }
  m_lost = m_used >= 0 && !used;
  if (other && !(used && touched(*used))) {
    m_used = other_number;
    m_state = *other;
  } else if (used) {
    m_state = *used;
  } else {
    m_used = -1;
    m_state = {};  // not yet touched: nobody's
  }
  const char* guid = m_seams.empty() && m_used >= 0 ? glfwGetJoystickGUID(m_used) : nullptr;
  m_guid = guid ? guid : "";
}

}  // namespace trocar::app
