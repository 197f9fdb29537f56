// The pictures a frame passes through on its way to the target.
#pragma once

#include <trocar/render/gl/gl_objects.hpp>

namespace trocar::render {

/// A colour texture that can be drawn into, with depth if asked.
struct GlPicture {
  int width = 0, height = 0;
  GlTexture colour;
  GlRenderbuffer depth;
  GlFramebuffer framebuffer;

  /// Makes it again unless it has this size already. @param format e.g. GL_RGBA16F
  void resize(int w, int h, GLenum format, bool with_depth, GLint filter);
  void bind() const;
};

/// What a scene is drawn into when its edges are to be smooth: several samples a pixel, which resolve() brings
/// together.
struct GlSampledPicture {
  int width = 0, height = 0, samples = 0;
  GlRenderbuffer colour, depth;
  GlFramebuffer framebuffer;

  /// RGBA16F with depth and stencil. Makes it again unless it is like that already.
  void resize(int w, int h, int samples);
  void bind() const;
  /// Colour (averaged), depth and stencil into a picture of this size.
  void resolve(const GlPicture& into) const;
};

}  // namespace trocar::render
