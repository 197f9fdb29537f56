#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/render/gl/gl_program.hpp>
#include <trocar/render/gl/shader_text.hpp>

namespace trocar::render {

namespace {

std::string_view shader_file(std::string_view name) {
  for (const ShaderText& file : shader_texts())
    if (file.name == name) return file.text;
  throw std::logic_error("no shader file " + std::string(name));
}

std::string with_includes(std::string_view text) {
  constexpr std::string_view mark = "#include \"";
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (line.substr(0, mark.size()) == mark)
      out += with_includes(shader_file(line.substr(mark.size(), line.rfind('"') - mark.size())));
    else
      out.append(line).push_back('\n');
    at = end + 1;
  }
  return out;
}

std::string define_lines(const std::string& defines) {
  std::string out;
  for (std::size_t at = 0; at < defines.size();) {
    const std::size_t end = std::min(defines.find(',', at), defines.size());
    std::string one = defines.substr(at, end - at);
    if (const auto equals = one.find('='); equals != std::string::npos)
      one[equals] = ' ';
    else
      one += " 1";
    out += "#define " + one + "\n";
    at = end + 1;
  }
  return out;
}

[[noreturn]] void refuse(const std::string& what, const char* log) {
  throw core::EnvironmentLacks("this graphics driver refuses the shader " + what +
                               "; update it, or set LIBGL_ALWAYS_SOFTWARE=1 to do without it:\n" + log);
}

GlShaderName compiled(GLenum stage, const std::string& file, const std::string& defines) {
  GlShaderName shader(glCreateShader(stage));
  const std::string text = "#version 330 core\n" + define_lines(defines) + with_includes(shader_file(file));
  const char* source = text.c_str();
  glShaderSource(shader.id(), 1, &source, nullptr);
  glCompileShader(shader.id());
  GLint good = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &good);
  if (!good) {
    std::vector<char> log(8192);
    glGetShaderInfoLog(shader.id(), GLsizei(log.size()), nullptr, log.data());
    refuse(file + " [" + defines + "]", log.data());
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const std::string& vertex_file, const std::string& fragment_file, const std::string& defines)
    : m_program(glCreateProgram()) {
  const GlShaderName vertex = compiled(GL_VERTEX_SHADER, vertex_file, defines);
  const GlShaderName fragment = compiled(GL_FRAGMENT_SHADER, fragment_file, defines);
  glAttachShader(m_program.id(), vertex.id());
  glAttachShader(m_program.id(), fragment.id());
  glLinkProgram(m_program.id());
  GLint good = 0;
  glGetProgramiv(m_program.id(), GL_LINK_STATUS, &good);
  if (!good) {
    std::vector<char> log(8192);
    glGetProgramInfoLog(m_program.id(), GLsizei(log.size()), nullptr, log.data());
    refuse(vertex_file + " + " + fragment_file + " [" + defines + "]", log.data());
  }
}

GLint GlProgram::location(const char* name) {
  const auto [at, is_new] = m_locations.try_emplace(name, -1);
  if (is_new) at->second = glGetUniformLocation(m_program.id(), name);
  return at->second;
}

void GlProgram::set(const char* name, int value) { glUniform1i(location(name), value); }
void GlProgram::set(const char* name, float value) { glUniform1f(location(name), value); }
void GlProgram::set(const char* name, float x, float y) { glUniform2f(location(name), x, y); }
void GlProgram::set(const char* name, float x, float y, float z, float w) { glUniform4f(location(name), x, y, z, w); }
void GlProgram::set(const char* name, Vec3f v) { glUniform3f(location(name), v.x, v.y, v.z); }
void GlProgram::set(const char* name, const Mat4& value) {
  glUniformMatrix4fv(location(name), 1, GL_FALSE, value.m.data());
}
void GlProgram::set_vec4s(const char* name, std::span<const float> values) {
  glUniform4fv(location(name), GLsizei(values.size() / 4), values.data());
}

void GlProgram::set_seed(const char* name, std::uint32_t value) { glUniform1ui(location(name), value); }

GlProgram& GlPrograms::get(const std::string& vertex_file, const std::string& fragment_file,
                           const std::string& defines) {
  const std::string key = vertex_file + "+" + fragment_file + "+" + defines;
  const auto found = m_programs.find(key);
  if (found != m_programs.end()) return found->second;
  return m_programs.try_emplace(key, vertex_file, fragment_file, defines).first->second;
}

}  // namespace trocar::render
