// Layers: the nearest surface of everything with a part's number, once more without light, read back and taken through
// the lens on the processor.
#include <utility>

#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {
namespace {

constexpr float kEnds = 0.2f;  ///< a fold that is less open than this has run out into nothing (surface.frag)

}  // namespace

void GlBackend::on_remember(std::span<const DrawItem* const> items) {
  m_transforms_before.clear();
  for (const DrawItem* item : items) {
    m_meshes.remember(item->mesh.id);
    m_transforms_before[item->mesh.id].push_back(item->transform);
  }
}

void GlBackend::LayerPictures::resize(int width, int height) {
  const bool anew = !surface.colour || surface.width != width || surface.height != height;
  surface.resize(width, height, GL_RGBA32F, true, GL_NEAREST);
  places.resize(width, height, GL_RGBA32F, false, GL_NEAREST);
  surface.bind();
  if (anew) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, places.colour.id(), 0);
}

void GlBackend::begin_layers(const Frame& frame, const Target& target, const Layout& layout) {
  begin_scene(frame, target, layout);
  m_layers.resize(layout.scene_w, layout.scene_h);
  const GLenum both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, both);
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void GlBackend::layer_items(std::span<const DrawItem* const> items, const Mat4& view_before) {
  GlProgram& program = m_programs.get("layers.vert", "layers.frag");
  program.use();
  program.set("u_projection", m_projection);
  std::unordered_map<std::uint32_t, std::size_t> drawn;
  for (const DrawItem* item : items) {
    const auto found = m_transforms_before.find(item->mesh.id);
    const std::size_t nth = drawn[item->mesh.id]++;
    const bool known =
        m_meshes.remembers(item->mesh.id) && found != m_transforms_before.end() && nth < found->second.size();
    program.set("u_model_view", m_view * item->transform);
    program.set("u_model_view_before", view_before * (known ? found->second[nth] : item->transform));
    program.set("u_part", (known ? 1.0f : -1.0f) * float(item->part + 1), item->translucent ? kEnds : -1.0f);
    if (item->translucent || item->material.two_sided)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    m_meshes.draw(item->mesh.id, item->level);
  }
}

void GlBackend::layer_liquids(const Frame& frame, const Layout& layout) {
  const Liquid& liquid = frame.liquid;
  const float part = -float(liquid.part + 1);
  glDisable(GL_CULL_FACE);
  if (!liquid.triangles.empty()) {
    bind_sheet(liquid);
    GlProgram& program = m_programs.get("sheet.vert", "layers.frag", "SHEET");
    program.use();
    program.set("u_view", m_view);
    program.set("u_projection", m_projection);
    program.set("u_part", part, 0);
    glDrawElements(GL_TRIANGLES, GLsizei(liquid.triangles.size()), GL_UNSIGNED_INT, nullptr);
  }
  if (liquid.splats.empty()) return;
  pack_splats(frame, layout.scene_h);
  if (m_splat_rows.empty()) return;
  bind_splats();
  GlProgram& program = m_programs.get("splat.vert", "layers.frag", "SPLAT");
  program.use();
  program.set("u_projection", m_projection);
  program.set("u_part", part, 0);
  glEnable(GL_POLYGON_OFFSET_FILL);  // what lies on tissue is to be seen on tissue that is drawn finer than its floor
  glPolygonOffset(-1, -2000);        // some tenths of a millimetre at 10 cm
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, splat_count());
  glDisable(GL_POLYGON_OFFSET_FILL);
}

RawLayers GlBackend::on_layers(const Frame& frame, std::span<const DrawItem* const> items, const Camera& before,
                               int width, int height) {
  const Target target = Target::off_screen(width, height);
  const Layout layout(target, frame.look, 1);
  begin_layers(frame, target, layout);
  layer_items(items, view_matrix(before.rotation, before.position));
  layer_liquids(frame, layout);
  RawLayers raw{layout.scene_w, layout.scene_h, {}, {}};
  const std::size_t n = std::size_t(4) * std::size_t(raw.width) * std::size_t(raw.height);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  for (const auto& [attachment, values] :
       {std::pair(GL_COLOR_ATTACHMENT0, &raw.surface), std::pair(GL_COLOR_ATTACHMENT1, &raw.places)}) {
    values->resize(n);
    glReadBuffer(GLenum(attachment));
    glReadPixels(0, 0, raw.width, raw.height, GL_RGBA, GL_FLOAT, values->data());
  }
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  leave_state_clean();
  return raw;
}

}  // namespace trocar::render
