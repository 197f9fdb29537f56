#include "window.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <thread>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/core/error.hpp>

namespace trocar::app {
namespace {

constexpr float kTextHeight = 15;

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
    {GLFW_KEY_Q, devices::Key::q},
    {GLFW_KEY_E, devices::Key::e},
    {GLFW_KEY_R, devices::Key::r},
    {GLFW_KEY_F, devices::Key::f},
    {GLFW_KEY_SPACE, devices::Key::space},
    {GLFW_KEY_LEFT_SHIFT, devices::Key::shift},
    {GLFW_KEY_RIGHT_SHIFT, devices::Key::shift},
};

}  // namespace

Window::Window(const std::string& title, PictureSize size) {
  if (!glfwInit())
    throw core::EnvironmentLacks(fmt::format(
        "cannot open a window: {}. Start it from a desktop (DISPLAY or WAYLAND_DISPLAY set), or use --headless with "
        "--input demo",
        last_glfw_error()));
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  m_window = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!m_window) {
    const std::string why = last_glfw_error();
    glfwTerminate();
    throw core::EnvironmentLacks(
        fmt::format("cannot open a window with OpenGL 3.3: {}. Update the graphics driver, or use --headless", why));
  }
  glfwSetWindowUserPointer(m_window, this);
  glfwMakeContextCurrent(m_window);
  glfwSwapInterval(1);
  glfwSetKeyCallback(m_window, on_key);
  glfwSetCursorPosCallback(m_window, on_cursor);
  glfwSetScrollCallback(m_window, on_scroll);
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
  glfwTerminate();
}

void Window::set_up_imgui() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;          // nothing of ours is left in people's folders
  ImGui_ImplGlfw_InitForOpenGL(m_window, true);  // calls our callbacks, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
  m_scale_changed = true;
}

namespace {

/// Text and panels for this display. A system font where there is one; ImGui's own is a 13 px bitmap.
void apply_scale(float scale) {
  ImGui::GetStyle() = ImGuiStyle();
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = ImGui::GetStyle().FrameRounding = 4;
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  const char* file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  std::error_code error;
  if (!std::filesystem::exists(file, error) || !io.Fonts->AddFontFromFileTTF(file, kTextHeight * scale)) {
    ImFontConfig config;
    config.SizePixels = kTextHeight * scale;
    io.Fonts->AddFontDefault(&config);
  }
  io.Fonts->Build();
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

}  // namespace

bool Window::wants_to_close() const { return glfwWindowShouldClose(m_window); }
void Window::close() { glfwSetWindowShouldClose(m_window, GLFW_TRUE); }

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
  if (m_scale_changed) {
    ImGui_ImplOpenGL3_NewFrame();
    apply_scale(m_scale);
    m_scale_changed = false;
  }
  glfwGetFramebufferSize(m_window, &m_width, &m_height);
  collect_sample();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::draw_panels() {
  ImGui::Render();
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
  m_keys = m_next_keys;
  m_next = {};
  m_next_keys = {};
  m_sample.dt = float(m_picture_time);
  if (!m_captured) return;
  m_sample.left_button = glfwGetMouseButton(m_window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
  m_sample.right_button = glfwGetMouseButton(m_window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
  for (const KeyPair& k : kKeys)
    if (glfwGetKey(m_window, k.glfw) == GLFW_PRESS) m_sample.held.set(k.key);
  read_gamepad();
}

void Window::read_gamepad() {
  GLFWgamepadstate pad;
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    if (!glfwJoystickIsGamepad(id) || !glfwGetGamepadState(id, &pad)) continue;
    const auto trigger = [&pad](int axis) { return 0.5f * (pad.axes[axis] + 1); };  // GLFW: -1 released .. 1 pulled
    m_sample.gamepad = {pad.axes[GLFW_GAMEPAD_AXIS_LEFT_X],
                        pad.axes[GLFW_GAMEPAD_AXIS_LEFT_Y],
                        pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_X],
                        pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y],
                        trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER),
                        trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER),
                        pad.buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER] == GLFW_PRESS,
                        pad.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS};
    return;
  }
}

void Window::on_key(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  Window& w = of(window);
  if (key == GLFW_KEY_F1 || key == GLFW_KEY_H) w.m_next_keys.help = !w.m_next_keys.help;
  if (key == GLFW_KEY_ESCAPE) w.m_next_keys.menu = !w.m_next_keys.menu;
  if (key == GLFW_KEY_F12) w.m_next_keys.picture = true;
  if (key == GLFW_KEY_R) w.m_next_keys.restart = true;
  if (key == GLFW_KEY_Q) w.m_next_keys.quit = true;
  for (const KeyPair& k : kKeys)
    if (k.glfw == key) w.m_next.pressed.set(k.key);
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
