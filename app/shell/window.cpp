#include "shell/window.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <thread>
#include <utility>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

std::string last_glfw_error() {
  const char* what = nullptr;
  glfwGetError(&what);
  return what ? what : "no reason given";
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

struct KeyPair {
  int glfw;
  devices::Key key;
};
constexpr KeyPair kKeys[] = {
    {GLFW_KEY_TAB, devices::Key::tab},
    {GLFW_KEY_1, devices::Key::one},
    {GLFW_KEY_2, devices::Key::two},
    {GLFW_KEY_3, devices::Key::three},
    {GLFW_KEY_4, devices::Key::four},
    {GLFW_KEY_0, devices::Key::zero},
    {GLFW_KEY_KP_1, devices::Key::one},
    {GLFW_KEY_KP_2, devices::Key::two},
    {GLFW_KEY_KP_3, devices::Key::three},
    {GLFW_KEY_KP_4, devices::Key::four},
    {GLFW_KEY_KP_0, devices::Key::zero},
    {GLFW_KEY_C, devices::Key::c},
    {GLFW_KEY_LEFT, devices::Key::left},
    {GLFW_KEY_RIGHT, devices::Key::right},
    {GLFW_KEY_UP, devices::Key::up},
    {GLFW_KEY_DOWN, devices::Key::down},
    {GLFW_KEY_PAGE_UP, devices::Key::page_up},
    {GLFW_KEY_PAGE_DOWN, devices::Key::page_down},
    {GLFW_KEY_W, devices::Key::w},
    {GLFW_KEY_S, devices::Key::s},
    {GLFW_KEY_Q, devices::Key::q},
    {GLFW_KEY_E, devices::Key::e},
    {GLFW_KEY_R, devices::Key::r},
    {GLFW_KEY_F, devices::Key::f},
    {GLFW_KEY_G, devices::Key::g},
    {GLFW_KEY_ENTER, devices::Key::enter},
    {GLFW_KEY_KP_ENTER, devices::Key::enter},
    {GLFW_KEY_V, devices::Key::v},
    {GLFW_KEY_X, devices::Key::x},
    {GLFW_KEY_B, devices::Key::b},
    {GLFW_KEY_N, devices::Key::n},
    {GLFW_KEY_H, devices::Key::h},
    {GLFW_KEY_SPACE, devices::Key::space},
    {GLFW_KEY_LEFT_SHIFT, devices::Key::shift},
    {GLFW_KEY_RIGHT_SHIFT, devices::Key::shift},
    {GLFW_KEY_A, devices::Key::a},
    {GLFW_KEY_D, devices::Key::d},
    {GLFW_KEY_T, devices::Key::t},
    {GLFW_KEY_K, devices::Key::k},
    {GLFW_KEY_I, devices::Key::i},
    {GLFW_KEY_J, devices::Key::j},
    {GLFW_KEY_L, devices::Key::l},
    {GLFW_KEY_M, devices::Key::m},
    {GLFW_KEY_U, devices::Key::u},
    {GLFW_KEY_O, devices::Key::o},
};

/// The size that was asked for, or what the monitor has room for.
pictures::PictureSize fitted(pictures::PictureSize size) {
  int x = 0, y = 0, width = 0, height = 0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return size;
  glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  float scale = 1, unused = 1;
  glfwGetMonitorContentScale(monitor, &scale, &unused);
  scale = std::max(scale, 0.5f);
  if (width > 0) size.width = std::min(size.width, int(float(width) / scale));
  if (height > 0) size.height = std::min(size.height, int(float(height) / scale));
  return size;
}

/// A software renderer that takes every core would take the simulation's, too. Read by Mesa when the context is made.
void leave_a_core_to_the_simulation() {
  const unsigned cores = std::max(2u, std::thread::hardware_concurrency());
  setenv("LP_NUM_THREADS", std::to_string(cores - 1).c_str(), 0);
}

}  // namespace

Window::Glfw::Glfw() {
  leave_a_core_to_the_simulation();
  if (!glfwInit())
    throw core::EnvironmentLacks(
        tr("cannot open a window: {}. Start it from a desktop (DISPLAY or WAYLAND_DISPLAY set), or use trocar train "
           "EXERCISE --headless --input demo",
           last_glfw_error()));
}
Window::Glfw::~Glfw() { glfwTerminate(); }

Window::Window(const std::string& title, pictures::PictureSize size, bool quad_buffers) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);  // where the driver can tell
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  size = fitted(size);
  glfwWindowHint(GLFW_STEREO, quad_buffers ? GLFW_TRUE : GLFW_FALSE);
  m_window = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!m_window && quad_buffers) {
    glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
    m_window = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  }
  if (!m_window)
    throw core::EnvironmentLacks(tr(
        "cannot open a window with OpenGL 3.3: {}. Update the graphics driver, or use --headless", last_glfw_error()));
  glfwSetWindowUserPointer(m_window, this);
  glfwSetWindowSizeLimits(m_window, 480, 360, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(m_window);
  glfwSwapInterval(1);
  GLboolean stereo = GL_FALSE;
  glGetBooleanv(GL_STEREO, &stereo);
  m_quad_buffers = stereo == GL_TRUE;
  glfwSetKeyCallback(m_window, on_key);
  glfwSetCursorPosCallback(m_window, on_cursor);
  glfwSetScrollCallback(m_window, on_scroll);
  glfwSetMouseButtonCallback(m_window, on_button);
  glfwSetDropCallback(m_window, on_drop);
  glfwSetWindowContentScaleCallback(m_window, on_scale);
  float unused_y = 1;
  glfwGetWindowContentScale(m_window, &m_scale, &unused_y);
  glfwGetFramebufferSize(m_window, &m_width, &m_height);
  set_up_imgui();
  m_last_time = glfwGetTime();
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(m_window);
}

void Window::set_up_imgui() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;          // nothing of ours is left in people's folders
  ImGui_ImplGlfw_InitForOpenGL(m_window, true);  // calls our callbacks, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
  m_scale_changed = true;
}

void Window::set_text_size(double size) {
  if (float(size) == m_text_size) return;
  m_text_size = float(size);
  m_scale_changed = true;
}

float fit_of(int width, int height, float display_scale) {
  constexpr float kWidth = 1280, kHeight = 720, kLeast = 0.8f, kMost = 4, kSteps = 20;
  const float fit = std::min(float(width) / kWidth, float(height) / kHeight) / std::max(0.5f, display_scale);
  return std::round(kSteps * std::clamp(fit, kLeast, kMost)) / kSteps;
}

void Window::fit_texts() {
  const float fit = fit_of(m_width, m_height, m_scale);
  if (fit == m_fit) return;
  m_fit = fit;
  m_scale_changed = true;
}

bool Window::full_screen() const { return glfwGetWindowMonitor(m_window) != nullptr; }

void Window::toggle_full_screen() {
  if (full_screen()) {
    glfwSetWindowMonitor(m_window, nullptr, m_plain.x, m_plain.y, m_plain.width, m_plain.height, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  glfwGetWindowPos(m_window, &m_plain.x, &m_plain.y);
  glfwGetWindowSize(m_window, &m_plain.width, &m_plain.height);
  glfwSetWindowMonitor(m_window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

bool Window::wants_to_close() const { return glfwWindowShouldClose(m_window); }
void Window::stay_open() { glfwSetWindowShouldClose(m_window, GLFW_FALSE); }
void Window::close() { glfwSetWindowShouldClose(m_window, GLFW_TRUE); }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(m_window, title.c_str()); }
bool Window::focused() const { return glfwGetWindowAttrib(m_window, GLFW_FOCUSED); }

pictures::PictureSize Window::size_to_keep() const {
  int width = 0, height = 0;
  glfwGetWindowSize(m_window, &width, &height);
  if (full_screen()) width = m_plain.width, height = m_plain.height;
  return {int(float(width) / m_scale), int(float(height) / m_scale)};
}

void Window::capture_pointer(bool on) {
  if (on == m_captured) return;
  m_captured = on;
  m_cursor_known = false;
  glfwSetInputMode(m_window, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  if (on && glfwRawMouseMotionSupported()) glfwSetInputMode(m_window, GLFW_RAW_MOUSE_MOTION, GLFW_FALSE);
}

void Window::begin_picture() {
  wait_for_turn();
  glfwPollEvents();
  m_gamepads.poll();
  glfwGetFramebufferSize(m_window, &m_width, &m_height);
  fit_texts();
  if (m_scale_changed) {
    ImGui_ImplOpenGL3_NewFrame();
    ui::load_fonts(scale());
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    m_scale_changed = false;
  }
  collect_sample();
  collect_keys();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  steer_menus();
  ImGui::NewFrame();
  clear();
  m_last_pad = m_gamepads.state();
}

/// What is between panes and panels.
void Window::clear() const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.05f, 0.05f, 0.06f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

/// Arrows, Enter and the gamepad lead from button to button. ImGui's own reading of gamepads takes the first joystick
/// as it comes, without GLFW's mapping; so its input is filled in here.
void Window::steer_menus() {
  ImGuiIO& io = ImGui::GetIO();
  std::fill(std::begin(io.NavInputs), std::end(io.NavInputs), 0.0f);
  io.ConfigFlags &= ~(ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad);
  // A key that went down and up between two pictures has been down in this one, too.
  for (const int key : m_keys_shown) io.KeysDown[key] = glfwGetKey(m_window, key) == GLFW_PRESS;
  m_keys_shown = std::exchange(m_keys_pressed, {});
  bool enter = glfwGetKey(m_window, GLFW_KEY_ENTER) == GLFW_PRESS;
  for (const int key : m_keys_shown) {
    io.KeysDown[key] = true;
    enter |= key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  }
  if (m_captured) return;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  if (enter && !io.WantTextInput) io.NavInputs[ImGuiNavInput_Activate] = 1;
  // ImGui shows a mouse's user no focus, and gives none, before an arrow was pressed. Here there always is one, and
  // what has it is what Enter or the gamepad's A will press.
  ImGui::GetCurrentContext()->NavDisableHighlight = false;
  if (!m_gamepads.present()) return;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad;
  io.BackendFlags |= ImGuiBackendFlags_HasGamepad;
  using devices::Button;
  const devices::Gamepad& pad = m_gamepads.state();
  const auto feed = [&io](ImGuiNavInput_ to, bool on) {
    if (on) io.NavInputs[to] = 1;
  };
  constexpr float kTilted = 0.5f;
  feed(ImGuiNavInput_Activate, pad.has(Button::a));
  feed(ImGuiNavInput_Cancel, pad.has(Button::b));
  feed(ImGuiNavInput_DpadLeft, pad.has(Button::left) || pad.left_x < -kTilted);
  feed(ImGuiNavInput_DpadRight, pad.has(Button::right) || pad.left_x > kTilted);
  feed(ImGuiNavInput_DpadUp, pad.has(Button::up) || pad.left_y < -kTilted);
  feed(ImGuiNavInput_DpadDown, pad.has(Button::down) || pad.left_y > kTilted);
}

void Window::draw_pointer(bool on) { ImGui::GetIO().MouseDrawCursor = on && !m_captured; }

void Window::draw_panels() {
  ImGui::Render();
  draw_panels_again();
}

void Window::draw_panels_again() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, m_width, m_height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::show() { glfwSwapBuffers(m_window); }

void Window::wait_for_turn() {
  const double left = m_last_time + m_least_time - glfwGetTime();
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
  const double now = glfwGetTime();
  m_picture_time = now - m_last_time;
  m_last_time = now;
}

void Window::collect_sample() {
  m_sample = m_captured ? m_next : devices::HandSample{};
  m_next = {};
  m_sample.dt = float(m_picture_time);
  m_sample.gamepad = m_gamepads.state();
  const unsigned pressed = std::exchange(m_buttons_pressed, 0);
  if (!m_captured) return;
  const auto down = [&](int button) {
    return glfwGetMouseButton(m_window, button) == GLFW_PRESS || (pressed >> button & 1);
  };
  m_sample.left_button = down(GLFW_MOUSE_BUTTON_LEFT);
  m_sample.right_button = down(GLFW_MOUSE_BUTTON_RIGHT);
  m_sample.middle_button = down(GLFW_MOUSE_BUTTON_MIDDLE);
  m_sample.back_button = down(GLFW_MOUSE_BUTTON_4);
  m_sample.forward_button = down(GLFW_MOUSE_BUTTON_5);
  for (const KeyPair& k : kKeys)
    if (glfwGetKey(m_window, k.glfw) == GLFW_PRESS) m_sample.held.set(k.key);
}

void Window::collect_keys() {
  m_keys = std::exchange(m_next_keys, {});
  m_typed = std::exchange(m_next_typed, {});
  m_dropped = std::exchange(m_next_dropped, {});
  if (ImGui::GetIO().WantTextInput) m_keys.pause = m_keys.back = false;
  const auto went_down = [this](devices::Button b) { return m_gamepads.state().has(b) && !m_last_pad.has(b); };
  m_keys.help |= went_down(devices::Button::back);
  m_keys.pause |= went_down(devices::Button::start);
  m_keys.back |= !m_captured && went_down(devices::Button::b);
}

void Window::on_key(GLFWwindow* window, int key, int, int action, int mods) {
  if (action != GLFW_RELEASE) of(window).m_next_typed.push_back({key, mods});
  if (action != GLFW_PRESS) return;
  Window& w = of(window);
  if (key >= 0 && key < int(std::size(ImGui::GetIO().KeysDown))) w.m_keys_pressed.push_back(key);
  if (key == GLFW_KEY_F1) w.m_next_keys.help = !w.m_next_keys.help;
  if (key == GLFW_KEY_P || key == GLFW_KEY_PAUSE) w.m_next_keys.pause = !w.m_next_keys.pause;
  if (key == GLFW_KEY_ESCAPE) w.m_next_keys.back = !w.m_next_keys.back;
  if (key == GLFW_KEY_F11) w.toggle_full_screen();
  if (key == GLFW_KEY_F12) w.m_next_keys.picture = true;
  if (key == GLFW_KEY_F2) w.m_next_keys.layout = true;
  if (key == GLFW_KEY_F3) w.m_next_keys.second = true;
  for (const KeyPair& k : kKeys)
    if (k.glfw == key) w.m_next.pressed.set(k.key);
}

void Window::on_drop(GLFWwindow* window, int count, const char** paths) {
  for (int i = 0; i < count; ++i) of(window).m_next_dropped.emplace_back(paths[i]);
}

void Window::on_button(GLFWwindow* window, int button, int, int) {
  of(window).m_buttons_pressed |= 1u << button;  // pressed or let go: it was down in this picture's time
}

void Window::on_cursor(GLFWwindow* window, double x, double y) {
  Window& w = of(window);
  if (w.m_captured && w.m_cursor_known) {
    w.m_next.dx += float(x - w.m_cursor_x);
    w.m_next.dy += float(y - w.m_cursor_y);
  }
  w.m_cursor_x = x;
  w.m_cursor_y = y;
  w.m_cursor_known = true;
}

void Window::on_scroll(GLFWwindow* window, double, double y) { of(window).m_next.wheel += float(y); }

void Window::on_scale(GLFWwindow* window, float x, float) {
  of(window).m_scale = x;
  of(window).m_scale_changed = true;
}

render::Image Window::read_back() const {
  render::Image image;
  image.width = m_width;
  image.height = m_height;
  std::vector<std::uint8_t> below_up(3 * std::size_t(m_width) * std::size_t(m_height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, m_width, m_height, GL_RGB, GL_UNSIGNED_BYTE, below_up.data());
  image.rgb.resize(below_up.size());
  const std::size_t row = 3 * std::size_t(m_width);
  for (int y = 0; y < m_height; ++y)
    std::copy_n(below_up.begin() + std::ptrdiff_t(row * std::size_t(y)), row,
                image.rgb.begin() + std::ptrdiff_t(row * std::size_t(m_height - 1 - y)));
  return image;
}

}  // namespace trocar::app
