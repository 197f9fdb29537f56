#include "player_backdrop.hpp"

#include <cstdint>

#include <epoxy/gl.h>
#include <imgui.h>

namespace trocar::app {

Backdrop::~Backdrop() {
  if (m_texture != 0) glDeleteTextures(1, &m_texture);
}

void Backdrop::copy(int x, int y, int width, int height) {
  if (m_texture == 0) glGenTextures(1, &m_texture);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glBindTexture(GL_TEXTURE_2D, m_texture);
  glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, x, y, width, height, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void Backdrop::draw(const Area& area) const {
  ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(m_texture)), {area.x, area.y},
                                           {area.x + area.width, area.y + area.height}, {0, 1}, {1, 0});
}

}  // namespace trocar::app
