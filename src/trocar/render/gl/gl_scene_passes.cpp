#include <algorithm>
#include <cmath>
#include <string>

#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {
namespace {

/// Whether the film's ripples are about as large as the fine flecks, so that one noise fetch can serve both.
bool film_serves_as_fine(const Material& m) {
  const float ratio = m.film_size / (0.2f * m.mottle_size);
  return m.shading != Shading::metal && ratio > 0.4f && ratio < 2.5f;
}

constexpr float kGhost = 0.3f, kGhostRim = 0.7f;  // how much of themselves transparent things show

}  // namespace

void GlBackend::begin_scene(const Frame& frame, const Target& target, const Layout& layout) {
  m_scene.resize(layout.scene_w, layout.scene_h, GL_RGBA16F, true, GL_LINEAR);
  m_scene.bind();
  if (frame.quality.samples > 1) {
    m_sampled.resize(layout.scene_w, layout.scene_h, frame.quality.samples);
    m_sampled.bind();
  }
  const Camera& camera = frame.camera;
  m_view = view_matrix(camera.rotation, camera.position);
  m_shift = camera.shift;
  const float part = float(layout.box_h) / float(target.height);
  const float fov = 2 * std::atan(part * std::tan(camera.vertical_fov / 2));
  m_projection =
      perspective(fov, float(layout.box_w) / float(layout.box_h), camera.near_plane, camera.far_plane, camera.shift);
  m_frame_rows = packed(frame);
  pack_rods(frame);

  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glFrontFace(GL_CCW);
  glCullFace(GL_BACK);
  glClearColor(frame.background.x, frame.background.y, frame.background.z, frame.camera.far_plane);
  glClearStencil(0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  bind_texture(kUnitNoise, GL_TEXTURE_3D, m_noise.id());
  bind_texture(kUnitCells, GL_TEXTURE_3D, m_cells.id());
  bind_texture(kUnitVessels, GL_TEXTURE_2D, m_vessels.id());
  bind_texture(kUnitArcade, GL_TEXTURE_2D, m_arcade.id());
  bind_texture(kUnitLining, GL_TEXTURE_2D, m_lining.id());
  // Mirrors show the picture before, if it was of the same view.
  const bool same_view = m_small.colour && m_small_eye == frame.eye;
  bind_texture(kUnitSmall, GL_TEXTURE_2D, same_view ? m_small.colour.id() : 0);
  bind_texture(kUnitSmaller, GL_TEXTURE_2D, same_view ? m_smaller.colour.id() : 0);
  m_frame_rows[17] = same_view ? 1.0f : 0.0f;
}

void GlBackend::mask_pass(const Layout& layout) {
  GlProgram& program = m_programs.get("mask.vert", "mask.frag");
  program.use();
  program.set("u_radius", 2 * layout.radius / float(layout.box_w), 2 * layout.radius / float(layout.box_h));
  glDisable(GL_CULL_FACE);
  glBindVertexArray(m_no_vertices.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * 97);
}

void GlBackend::set_blending(bool on) {
  if (on)
    glEnable(GL_BLEND);
  else
    glDisable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDepthMask(on ? GL_FALSE : GL_TRUE);
}

void GlBackend::scene_pass(const Frame& frame, std::span<const DrawItem* const> items, bool blended) {
  set_blending(blended);
  if (!blended) glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  for (const DrawItem* item : items) {
    glStencilFunc(GL_ALWAYS, item->material.shading == Shading::metal ? kStencilMetal : 0, kStencilMetal);
    draw_item(frame, *item, blended, is_stained(item->mesh));
  }
  glDisable(GL_STENCIL_TEST);
  set_blending(false);
}

void GlBackend::before_pool_pass(const Frame& frame, std::span<const DrawItem* const> items) {
  set_blending(true);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glStencilFunc(GL_EQUAL, kStencilPool, kStencilPool);
  for (const DrawItem* item : items) draw_item(frame, *item, true, is_stained(item->mesh));
  glDisable(GL_STENCIL_TEST);
  set_blending(false);
}

void GlBackend::resolve_pass(const Frame& frame) {
  if (frame.quality.samples <= 1) return;
  m_sampled.resolve(m_scene);
  m_scene.bind();
}

void GlBackend::draw_edges(const DrawItem& item) {
  GlProgram& program = m_programs.get("flat.vert", "wire.frag");
  program.use();
  program.set("u_model_view", m_view * item.transform);
  program.set("u_projection", m_projection);
  program.set_vec4s("u_frame", m_frame_rows);
  const Vec3f colour = item.material.colour;
  const auto lighter = [](float c) { return 0.12f + 0.88f * c; };
  program.set("u_tone", lighter(colour.x), lighter(colour.y), lighter(colour.z), 1);
  m_meshes.draw_edges(item.mesh.id, indices_of_mesh(item.mesh));
}

void GlBackend::draw_item(const Frame& frame, const DrawItem& item, bool blended, bool stained) {
  if (item.style == DrawStyle::wireframe && !m_meshes.is_lines(item.mesh.id)) return draw_edges(item);
  Material material = item.material;
  const bool ghost = item.style == DrawStyle::transparent;
  if (ghost) material.alpha *= kGhost, material.rim_alpha *= kGhostRim;
  const bool two_sided = (blended && !(ghost && !item.translucent)) || material.two_sided;
  GlProgram& program = program_for(frame, material, std::min(frame.quality.detail, int(item.detail)), blended, stained);
  program.use();
  program.set("u_model_view", m_view * item.transform);
  program.set("u_projection", m_projection);
  program.set_vec4s("u_frame", m_frame_rows);
  if (material.shading == Shading::vertex_colour || material.shading == Shading::unlit) {
    program.set("u_tone", 1, 1, 1, material.alpha);
    if (material.shading == Shading::vertex_colour) program.set("u_gloss", 0.1f * material.wetness);
  } else {
    program.set_vec4s("u_material", packed(material));
    program.set("u_noise", kUnitNoise);
    program.set("u_cells", kUnitCells);
    program.set("u_vessels", material.arcade ? kUnitArcade : material.lining ? kUnitLining : kUnitVessels);
    program.set("u_before", material.shading == Shading::metal ? kUnitSmaller : kUnitSmall);  // worn metal blurs
    if (blended && m_rod_count > 0) set_rods_near(frame, item, program);
  }
  program.set("u_blended", blended ? 1.0f : 0.0f);
  if (two_sided || m_meshes.is_lines(item.mesh.id))
    glDisable(GL_CULL_FACE);
  else
    glEnable(GL_CULL_FACE);
  m_meshes.draw(item.mesh.id, item.level);
}

GlProgram& GlBackend::program_for(const Frame& frame, const Material& material, int detail, bool blended,
                                  bool stained) {
  if (material.shading == Shading::unlit) return m_programs.get("flat.vert", "flat.frag");
  if (material.shading == Shading::vertex_colour) return m_programs.get("flat.vert", "flat.frag", "LIT");
  std::string defines = "SHADING=" + std::to_string(int(material.shading)) + ",DETAIL=" + std::to_string(detail);
  const bool tissue = material.shading == Shading::tissue;
  if (detail > 1 && !film_serves_as_fine(material)) defines += ",FINE";
  if (tissue && material.vessels > 0 && detail > 0) defines += material.arcade ? ",VESSELS,ARCADE" : ",VESSELS";
  if (tissue && material.lining) defines += ",LINING";
  if (tissue && material.lobule_size > 0) defines += ",LOBULES";
  if (stained) defines += ",STAINED";
  if (frame.look.fog > 0) defines += ",FOGGY";
  if (tissue && blended && m_rod_count > 0) defines += ",RODS";
  if (blended || material.two_sided) defines += ",TWO_SIDED";
  return m_programs.get("surface.vert", "surface.frag", defines);
}

void GlBackend::puff_pass(const Frame& frame) {
  if (frame.puffs.empty()) return;
  m_puffs.clear();
  for (const Puff& puff : frame.puffs) m_puffs.push_back({transform_point(m_view, puff.centre), &puff});
  std::stable_sort(m_puffs.begin(), m_puffs.end(),
                   [](const SeenPuff& a, const SeenPuff& b) { return a.eye.z < b.eye.z; });
  GlProgram& program = m_programs.get("puff.vert", "puff.frag");
  program.use();
  program.set("u_projection", m_projection);
  program.set_vec4s("u_frame", m_frame_rows);
  program.set("u_noise", kUnitNoise);
  program.set("u_right", frame.camera.rotation.column(0));
  program.set("u_up", frame.camera.rotation.column(1));
  constexpr float kRise = 0.06f;  // [m/s] of a plume's curls, about as fast as its puffs
  const Vec3f risen = (kRise * 1e-3f * float(frame.tick % 1000000)) * frame.smoke.up;
  set_blending(true);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(m_no_vertices.id());
  for (const SeenPuff& seen : m_puffs) {
    const Puff& puff = *seen.puff;
    program.set("u_puff", seen.eye.x, seen.eye.y, seen.eye.z, puff.radius);
    const Vec3f curls = puff.centre - risen;
    program.set("u_look", puff.density, curls.x, curls.y, curls.z);
    program.set("u_reach", puff.radius);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  set_blending(false);
}

}  // namespace trocar::render
