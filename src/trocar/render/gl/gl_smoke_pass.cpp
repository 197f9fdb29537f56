// Smoke: the grid of densities becomes a volume texture, a ray a pixel goes through it. The result is laid over the
// scene as it is developed (develop.frag), after shadows.
#include <algorithm>
#include <cmath>
#include <string>

#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {

void GlBackend::smoke_pass(const Frame& frame) {
  const SmokeVolume& smoke = frame.smoke;
  m_smokes = false;
  if (smoke.empty()) return;
  const float most = *std::max_element(smoke.density.begin(), smoke.density.end());
  if (most * smoke.kappa < 0.02f) return;  // a metre of it would take 2 %
  // A byte a cell will not do for a puff beside a haze: the square root spreads the scale.
  m_smoke_bytes.resize(smoke.density.size());
  for (std::size_t i = 0; i < smoke.density.size(); ++i)
    m_smoke_bytes[i] = std::uint8_t(255 * std::sqrt(smoke.density[i] / most) + 0.5f);
  const std::array<int, 3> size{smoke.nx, smoke.ny, smoke.nz};
  glActiveTexture(GLenum(GL_TEXTURE0 + kUnitCells));
  if (size != m_smoke_size) {
    m_smoke_grid = new_texture();
    m_smoke_size = size;
    glBindTexture(GL_TEXTURE_3D, m_smoke_grid.id());
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
  }
  glBindTexture(GL_TEXTURE_3D, m_smoke_grid.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, size[0], size[1], size[2], 0, GL_RED, GL_UNSIGNED_BYTE, m_smoke_bytes.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);

  const int part = frame.quality.detail > 1 ? 5 : (frame.quality.detail > 0 ? 6 : 8);  // smoke is soft
  m_smoke.resize((m_scene.width + part - 1) / part, (m_scene.height + part - 1) / part, GL_RGBA16F, false, GL_NEAREST);
  m_smoke.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  GlProgram& program = m_programs.get("full.vert", "smoke.frag", "DETAIL=" + std::to_string(frame.quality.detail));
  program.use();
  program.set_vec4s("u_frame", m_frame_rows);
  program.set("u_scene", kUnitPicture);
  program.set("u_grid", kUnitCells);
  program.set("u_noise", kUnitNoise);
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
  program.set("u_tan", Vec3f{1 / m_projection.m[0], 1 / m_projection.m[5], m_shift});
  const Mat3f& turn = frame.camera.rotation;
  program.set("u_right", turn.column(0));
  program.set("u_up", turn.column(1));
  program.set("u_back", turn.column(2));
  const Vec3f from = frame.camera.position - smoke.origin, extent{float(size[0]), float(size[1]), float(size[2])};
  program.set("u_from", from.x, from.y, from.z, 1 / smoke.cell);
  program.set("u_extent", extent);
  program.set("u_dense", most * smoke.kappa);
  const float risen = smoke.rise * 1e-3f * float(frame.tick % 1000000);
  program.set("u_risen", risen * smoke.up);
  draw_full();

  glEnable(GL_DEPTH_TEST);
  m_smokes = true;
}

void GlBackend::set_smoke(const SmokeVolume& smoke, GlProgram& program) {
  program.set("u_smoke", kUnitBed);
  bind_texture(kUnitBed, GL_TEXTURE_2D, m_smoke.colour.id());
  program.set("u_smoke_colour", smoke.colour);
  program.set("u_smoke_near", smoke.near_colour);
}

}  // namespace trocar::render
