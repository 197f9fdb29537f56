#include "shell/second_window.hpp"

#include <algorithm>

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/core/error.hpp>

namespace trocar::app {
namespace {

constexpr int kLeast = 240;  // [px] narrower than that nothing is seen

/// Free space beside a window on its only monitor, at the side where there is more.
struct Beside {
  int x = 0, y = 0, width = 0, height = 0;
  explicit Beside(GLFWwindow* main) {
    int left = 0, top = 0, wide = 0, high = 0, own_x = 0, own_y = 0, own_width = 0, own_height = 0;
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (!monitor) return;
    glfwGetMonitorWorkarea(monitor, &left, &top, &wide, &high);
    glfwGetWindowPos(main, &own_x, &own_y);
    glfwGetWindowSize(main, &own_width, &own_height);
    const int before = own_x - left, after = left + wide - own_x - own_width;
    x = after >= before ? own_x + own_width : left;
    y = std::max(top, own_y);
    width = std::max(before, after);
    height = std::min(width * 3 / 4, top + high - y);
  }
  bool fits() const { return width >= kLeast && height >= kLeast * 3 / 4; }
};

/// In its own context while this lives; afterwards in the main window's again.
class Current {
 public:
  Current(GLFWwindow* own, GLFWwindow* main) : m_main(main) { glfwMakeContextCurrent(own); }
  ~Current() { glfwMakeContextCurrent(m_main); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  GLFWwindow* m_main;
};

/// What lies nearest to (x, y) with the picture's shape, in a window of that size.
struct Fit {
  int x = 0, y = 0, width = 0, height = 0;
  Fit(int picture_width, int picture_height, int room_width, int room_height) {
    const double scale = std::min(double(room_width) / picture_width, double(room_height) / picture_height);
    width = std::max(1, int(scale * picture_width));
    height = std::max(1, int(scale * picture_height));
    x = (room_width - width) / 2;
    y = (room_height - height) / 2;
  }
};

}  // namespace

bool SecondWindow::has_room(const Window& main) {
  int monitors = 0;
  glfwGetMonitors(&monitors);
  return monitors > 1 || Beside(main.handle()).fits();
}

SecondWindow::SecondWindow(Window& main, const std::string& title) : m_main(main) {
  int monitors = 0;
  GLFWmonitor** monitor = glfwGetMonitors(&monitors);
  const GLFWvidmode* mode = monitors > 1 ? glfwGetVideoMode(monitor[1]) : nullptr;
  glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);  // keys stay with the main window
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  glfwWindowHint(GLFW_DECORATED, mode ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, mode ? GLFW_FALSE : GLFW_TRUE);
  const Beside beside(main.handle());
  if (!mode && !beside.fits()) throw core::EnvironmentLacks("no space for a second window beside the first one");
  m_window = glfwCreateWindow(mode ? mode->width : beside.width, mode ? mode->height : beside.height, title.c_str(),
                              nullptr, main.handle());
  glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
  glfwWindowHint(GLFW_DECORATED, GLFW_TRUE);
  if (!m_window) throw core::EnvironmentLacks("cannot open a second window");
  if (mode) {
    int x = 0, y = 0;
    glfwGetMonitorPos(monitor[1], &x, &y);
    glfwSetWindowPos(m_window, x, y);
    glfwShowWindow(m_window);
  } else {
    glfwSetWindowPos(m_window, beside.x, beside.y);
  }
  const Current current(m_window, main.handle());
  glfwSwapInterval(0);  // the main window waits for its display, and that is enough
  glGenFramebuffers(1, &m_picture);
  glGenFramebuffers(1, &m_legend);
  glGenTextures(1, &m_legend_texture);
}

SecondWindow::~SecondWindow() {
  {
    const Current current(m_window, m_main.handle());
    glDeleteFramebuffers(1, &m_picture);
    glDeleteFramebuffers(1, &m_legend);
    glDeleteTextures(1, &m_legend_texture);
  }
  glfwDestroyWindow(m_window);
}

bool SecondWindow::wants_to_close() const { return glfwWindowShouldClose(m_window); }
void SecondWindow::set_title(const std::string& title) { glfwSetWindowTitle(m_window, title.c_str()); }

int SecondWindow::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(m_window, &width, &height);
  return std::max(1, width);
}
int SecondWindow::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(m_window, &width, &height);
  return std::max(1, height);
}

/// As a texture, uploaded when it is another one than last time.
void SecondWindow::take_legend(const view::Legend& legend) {
  const render::Image image = m_painter.alone(legend, std::clamp(height() / 42, 11, 40));
  if (image.rgb == m_legend_shown) return;
  m_legend_shown = image.rgb;
  m_legend_width = image.width;
  m_legend_height = image.height;
  if (image.rgb.empty()) return;
  glBindTexture(GL_TEXTURE_2D, m_legend_texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, m_legend);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, m_legend_texture, 0);
}

void SecondWindow::show(const PaneCanvas& picture, const view::Legend& legend) {
  if (picture.texture() == 0) return;
  glFlush();  // what this context has drawn is what the other one shall see
  const int room_width = width(), room_height = height();
  const Current current(m_window, m_main.handle());
  take_legend(legend);
  glBindFramebuffer(GL_FRAMEBUFFER, m_picture);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture.texture(), 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  const Fit fit(picture.width(), picture.height(), room_width, room_height);
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), fit.x, fit.y, fit.x + fit.width, fit.y + fit.height,
                    GL_COLOR_BUFFER_BIT, GL_LINEAR);
  if (!m_legend_shown.empty()) {  // rows of images run from the top
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_legend);
    glBlitFramebuffer(0, 0, m_legend_width, m_legend_height, 0, m_legend_height, m_legend_width, 0, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  glFlush();
  glfwSwapBuffers(m_window);
}

}  // namespace trocar::app
