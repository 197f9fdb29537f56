// Owners for OpenGL names: each deletes its name when it goes. The context must be current then.
#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace trocar::render {

template <class Delete>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint id) : m_id(id) {}
  GlName(GlName&& other) noexcept : m_id(std::exchange(other.m_id, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(m_id, other.m_id);
    return *this;
  }
  ~GlName() {
    if (m_id) Delete{}(m_id);
  }
  GLuint id() const { return m_id; }
  explicit operator bool() const { return m_id != 0; }

 private:
  GLuint m_id = 0;
};

struct DeleteTexture {
  void operator()(GLuint id) const { glDeleteTextures(1, &id); }
};
struct DeleteBuffer {
  void operator()(GLuint id) const { glDeleteBuffers(1, &id); }
};
struct DeleteVertexArray {
  void operator()(GLuint id) const { glDeleteVertexArrays(1, &id); }
};
struct DeleteFramebuffer {
  void operator()(GLuint id) const { glDeleteFramebuffers(1, &id); }
};
struct DeleteRenderbuffer {
  void operator()(GLuint id) const { glDeleteRenderbuffers(1, &id); }
};
struct DeleteProgram {
  void operator()(GLuint id) const { glDeleteProgram(id); }
};
struct DeleteQuery {
  void operator()(GLuint id) const { glDeleteQueries(1, &id); }
};
struct DeleteShader {
  void operator()(GLuint id) const { glDeleteShader(id); }
};
using GlTexture = GlName<DeleteTexture>;
using GlBuffer = GlName<DeleteBuffer>;
using GlVertexArray = GlName<DeleteVertexArray>;
using GlFramebuffer = GlName<DeleteFramebuffer>;
using GlRenderbuffer = GlName<DeleteRenderbuffer>;
using GlQuery = GlName<DeleteQuery>;
using GlProgramName = GlName<DeleteProgram>;
using GlShaderName = GlName<DeleteShader>;

inline GlTexture new_texture() {
  GLuint id = 0;
  glGenTextures(1, &id);
  return GlTexture(id);
}
inline GlBuffer new_buffer() {
  GLuint id = 0;
  glGenBuffers(1, &id);
  return GlBuffer(id);
}
inline GlVertexArray new_vertex_array() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return GlVertexArray(id);
}
inline GlFramebuffer new_framebuffer() {
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  return GlFramebuffer(id);
}
inline GlRenderbuffer new_renderbuffer() {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  return GlRenderbuffer(id);
}
inline GlQuery new_query() {
  GLuint id = 0;
  glGenQueries(1, &id);
  return GlQuery(id);
}

}  // namespace trocar::render
