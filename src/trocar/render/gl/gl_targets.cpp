#include <algorithm>
#include <stdexcept>

#include <trocar/render/gl/gl_targets.hpp>

namespace trocar::render {

namespace {

struct Transfer {
  GLenum layout, type;
};
Transfer transfer_of(GLenum format) {
  switch (format) {
    case GL_RGBA16F:
      return {GL_RGBA, GL_HALF_FLOAT};
    case GL_RGBA32F:
      return {GL_RGBA, GL_FLOAT};
    case GL_R32F:
      return {GL_RED, GL_FLOAT};
    default:
      return {GL_RGBA, GL_UNSIGNED_BYTE};
  }
}

}  // namespace

void GlPicture::resize(int w, int h, GLenum format, bool with_depth, GLint filter) {
  w = std::max(w, 1);
  h = std::max(h, 1);
  if (colour && w == width && h == height) return;
  width = w;
  height = h;
  colour = new_texture();
  framebuffer = new_framebuffer();
  glBindTexture(GL_TEXTURE_2D, colour.id());
  const Transfer transfer = transfer_of(format);
  glTexImage2D(GL_TEXTURE_2D, 0, GLint(format), w, h, 0, transfer.layout, transfer.type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.id(), 0);
  if (with_depth) {
    depth = new_renderbuffer();
    glBindRenderbuffer(GL_RENDERBUFFER, depth.id());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, w, h);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.id());
  }
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver refuses a picture format that the renderer needs");
}

void GlPicture::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, width, height);
}

void GlSampledPicture::resize(int w, int h, int wanted) {
  w = std::max(w, 1);
  h = std::max(h, 1);
  if (framebuffer && w == width && h == height && wanted == samples) return;
  width = w;
  height = h;
  samples = wanted;
  framebuffer = new_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  const auto attach = [&](GlRenderbuffer& buffer, GLenum format, GLenum as) {
    buffer = new_renderbuffer();
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, w, h);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, as, GL_RENDERBUFFER, buffer.id());
  };
  attach(colour, GL_RGBA16F, GL_COLOR_ATTACHMENT0);
  attach(depth, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver refuses a picture format that the renderer needs");
}

void GlSampledPicture::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, width, height);
}

void GlSampledPicture::resolve(const GlPicture& into) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, into.framebuffer.id());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
}

}  // namespace trocar::render
