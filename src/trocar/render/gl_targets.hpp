// The pictures a frame passes through on its way to the target.
#pragma once

#include <trocar/render/gl_objects.hpp>

namespace trocar::render {

/// A colour texture that can be drawn into, with depth if asked.
struct GlPicture {
  int width = 0, height = 0;
  GlTexture colour;
  GlRenderbuffer depth;
  GlFramebuffer framebuffer;

  /// Makes it anew unless it has this size already. @param format e.g. GL_RGBA16F
  void resize(int w, int h, GLenum format, bool with_depth, GLint filter);
  void bind() const;
};

}  // namespace trocar::render
