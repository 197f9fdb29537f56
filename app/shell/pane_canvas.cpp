#include "shell/pane_canvas.hpp"

#include <utility>

#include <epoxy/gl.h>

namespace trocar::app {

PaneCanvas::PaneCanvas(PaneCanvas&& other) noexcept
    : m_texture(std::exchange(other.m_texture, 0)),
      m_framebuffer(std::exchange(other.m_framebuffer, 0)),
      m_width(other.m_width),
      m_height(other.m_height) {}

PaneCanvas::~PaneCanvas() {
  if (m_framebuffer != 0) glDeleteFramebuffers(1, &m_framebuffer);
  if (m_texture != 0) glDeleteTextures(1, &m_texture);
}

render::Target PaneCanvas::target(int width, int height) {
  if (m_texture == 0) {
    glGenTextures(1, &m_texture);
    glGenFramebuffers(1, &m_framebuffer);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, m_framebuffer);
  if (width != m_width || height != m_height) {
    glBindTexture(GL_TEXTURE_2D, m_texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, m_texture, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    m_width = width;
    m_height = height;
  }
  render::Target target = render::Target::window(width, height);
  target.framebuffer = m_framebuffer;
  return target;
}

void PaneCanvas::copy(const render::Target& from) {
  target(from.width, from.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, m_framebuffer);
  glBlitFramebuffer(from.x, from.y, from.x + from.width, from.y + from.height, 0, 0, from.width, from.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void PaneCanvas::lay(const render::Target& to, bool mirrored) const {
  if (m_framebuffer == 0) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, m_framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer);
  const int left = mirrored ? m_width : 0, right = m_width - left;
  glBlitFramebuffer(left, 0, right, m_height, to.x, to.y, to.x + to.width, to.y + to.height, GL_COLOR_BUFFER_BIT,
                    GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace trocar::app
