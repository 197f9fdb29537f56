// Shader programs from the embedded files. A file may say  #include "common.glsl"  on a line of its own; `defines`
// choose a variant. Compiled when first asked for.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>

#include <trocar/numerics/vec3.hpp>
#include <trocar/render/frame/mat4.hpp>
#include <trocar/render/gl/gl_objects.hpp>

namespace trocar::render {

class GlProgram {
 public:
  /// @param defines comma separated, as "DETAIL=2,VESSELS"
  /// @throws core::EnvironmentLacks with the driver's log where it refuses them
  GlProgram(const std::string& vertex_file, const std::string& fragment_file, const std::string& defines);

  void use() const { glUseProgram(m_program.id()); }
  // Uniforms that a variant does not use are silently skipped, as in GL.
  void set(const char* name, int value);
  void set(const char* name, float value);
  void set(const char* name, float x, float y);
  void set(const char* name, float x, float y, float z, float w);
  void set(const char* name, Vec3f value);
  void set(const char* name, const Mat4& value);
  void set_vec4s(const char* name, std::span<const float> values);
  void set_seed(const char* name, std::uint32_t value);

 private:
  GLint location(const char* name);

  GlProgramName m_program;
  std::unordered_map<std::string, GLint> m_locations;
};

class GlPrograms {
 public:
  GlProgram& get(const std::string& vertex_file, const std::string& fragment_file, const std::string& defines = "");

 private:
  std::unordered_map<std::string, GlProgram> m_programs;
};

}  // namespace trocar::render
