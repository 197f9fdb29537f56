// Liquids: the sheet as a mesh over what lies below it, drops and films as one surface made of splats.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {
namespace {

constexpr std::size_t kSplatFloats = 16;
constexpr int kTile = 8;              // [px] of the scene: only those that liquid reaches are drawn
constexpr float kLeastTexel = 0.75f;  // no drop is drawn thinner, in texels of the field

void attribute(GLuint index, GLint components, std::size_t floats, std::size_t first, GLuint divisor) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, GLsizei(floats * sizeof(float)),
                        reinterpret_cast<const void*>(first * sizeof(float)));
  glVertexAttribDivisor(index, divisor);
}

/// Grows to hold what points within `radius` of an eye-space point cover.
struct Bounds2 {
  float x0 = 9, y0 = 9, x1 = -9, y1 = -9;  ///< clip space
  void add(Vec3f eye, float radius, const Mat4& projection) {
    const float far = std::max(-eye.z - radius, 1e-3f);
    const float x = projection.m[0] * eye.x / std::max(-eye.z, 1e-3f) - projection.m[8],
                rx = projection.m[0] * radius / far;
    const float y = projection.m[5] * eye.y / std::max(-eye.z, 1e-3f), ry = projection.m[5] * radius / far;
    x0 = std::min(x0, x - rx), x1 = std::max(x1, x + rx);
    y0 = std::min(y0, y - ry), y1 = std::max(y1, y + ry);
  }
  void add(const Bounds2& o) {
    x0 = std::min(x0, o.x0), x1 = std::max(x1, o.x1);
    y0 = std::min(y0, o.y0), y1 = std::max(y1, o.y1);
  }
  std::array<int, 4> pixels(int width, int height) const {
    const auto px = [](float clip, int size) {
      return std::clamp(int((0.5f + 0.5f * std::clamp(clip, -2.0f, 2.0f)) * float(size)), 0, size);
    };
    const int left = std::max(px(x0, width) - 2, 0), low = std::max(px(y0, height) - 2, 0);
    const int right = std::min(px(x1, width) + 3, width), high = std::min(px(y1, height) + 3, height);
    return {left, low, std::max(right - left, 0), std::max(high - low, 0)};
  }
};

/// How many of the scene's pixels one of the field's is wide.
int wet_part(const Quality& quality) { return quality.detail > 0 ? 2 : 3; }

float code_of(const Splat& s) { return float(int(s.kind)) + (s.sheer ? 4.0f : 0.0f); }

}  // namespace

void GlBackend::keep_bed() {
  m_bed.resize(m_scene.width, m_scene.height, GL_RGBA16F, false, GL_LINEAR);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, m_scene.framebuffer.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, m_bed.framebuffer.id());
  const int x = m_wet_box[0], y = m_wet_box[1], right = x + m_wet_box[2], top = y + m_wet_box[3];
  glBlitFramebuffer(x, y, right, top, x, y, right, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  m_scene.bind();
  bind_texture(kUnitBed, GL_TEXTURE_2D, m_bed.colour.id());
}

void GlBackend::set_liquid(const Frame& frame, GlProgram& program) {
  const LiquidLook& look = frame.liquid.look;
  std::array<float, 8 * kLiquidKinds> rows{};
  for (int k = 0; k < kLiquidKinds; ++k) {
    const LiquidLook::Kind& kind = look.kinds[std::size_t(k)];
    const float row[8] = {kind.absorbs.x + kind.scatters,
                          kind.absorbs.y + kind.scatters,
                          kind.absorbs.z + kind.scatters,
                          kind.orange,
                          kind.deep.x,
                          kind.deep.y,
                          kind.deep.z,
                          kind.cells};
    std::copy(row, row + 8, &rows[std::size_t(8 * k)]);
  }
  program.set_vec4s("u_kinds", rows);
  program.set("u_orange", look.orange_share);
  const auto alpha2 = [](float roughness) { return roughness * roughness * roughness * roughness; };
  program.set("u_shine", look.fresnel, alpha2(look.drop_roughness), alpha2(look.film_roughness), look.dark);
  program.set_vec4s("u_frame", m_frame_rows);
  program.set("u_projection", m_projection);
  program.set("u_bed", kUnitBed);
  program.set("u_noise", kUnitNoise);
  const float tan_y = 1 / m_projection.m[5], tan_x = 1 / m_projection.m[0];
  program.set("u_tan", Vec3f{tan_x, tan_y, m_shift});
  program.set("u_size", float(m_scene.width), float(m_scene.height), 1.0f / float(m_scene.width),
              1.0f / float(m_scene.height));
  const Mat3f& turn = frame.camera.rotation;
  program.set("u_right", turn.column(0));
  program.set("u_up", turn.column(1));
  program.set("u_back", turn.column(2));
  program.set("u_down", frame.liquid.down);
  const Vec3f eye = frame.camera.position;
  program.set("u_eye", eye.x, eye.y, eye.z, 1e-3f * float(frame.tick % 1000000));
}

void GlBackend::sheet_pass(const Frame& frame, const Layout&) {
  const Liquid& liquid = frame.liquid;
  if (liquid.triangles.empty()) return;
  Bounds2 bounds;
  for (const SheetVertex& v : liquid.sheet) {
    const Vec3f eye = transform_point(m_view, v.position);
    if (eye.z < 0) bounds.add(eye, 0.002f, m_projection);
  }
  m_wet_box = bounds.pixels(m_scene.width, m_scene.height);
  if (m_wet_box[2] == 0 || m_wet_box[3] == 0) return;
  // What the sheet mirrors lies anywhere in the picture.
  const std::array<int, 4> all{0, 0, m_scene.width, m_scene.height};
  if (frame.quality.detail > 1) m_wet_box = all;
  keep_bed();
  bind_sheet(liquid);
  const auto count = GLsizei(liquid.triangles.size());
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_STENCIL_TEST);
  mark_pool(count);
  GlProgram& program = m_programs.get("sheet.vert", "sheet.frag", "DETAIL=" + std::to_string(frame.quality.detail));
  program.use();
  set_liquid(frame, program);
  program.set("u_view", m_view);
  glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
}

/// Only what shows of the sheet passes the tests of depth and stencil afterwards.
void GlBackend::mark_pool(GLsizei count) {
  GlProgram& program = m_programs.get("sheet.vert", "sheet_mark.frag");
  program.use();
  program.set("u_view", m_view);
  program.set("u_projection", m_projection);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glStencilFunc(GL_ALWAYS, kStencilPool, kStencilPool);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glStencilFunc(GL_EQUAL, kStencilPool, kStencilPool);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void GlBackend::bind_sheet(const Liquid& liquid) {
  if (!m_sheet_buffer) {
    m_sheet_layout = new_vertex_array();
    m_sheet_buffer = new_buffer();
    m_sheet_indices = new_buffer();
    glBindVertexArray(m_sheet_layout.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_sheet_buffer.id());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m_sheet_indices.id());
    static_assert(sizeof(SheetVertex) == 12 * sizeof(float));
    for (GLuint k = 0; k < 3; ++k) attribute(k, 4, 12, 4 * k, 0);
  }
  glBindVertexArray(m_sheet_layout.id());
  glBindBuffer(GL_ARRAY_BUFFER, m_sheet_buffer.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(liquid.sheet.size() * sizeof(SheetVertex)), liquid.sheet.data(),
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(liquid.triangles.size() * sizeof(std::uint32_t)),
               liquid.triangles.data(), GL_STREAM_DRAW);
}

void GlBackend::mark_tiles(const std::array<int, 4>& box) {
  const int columns = (m_scene.width + kTile - 1) / kTile;
  for (int j = box[1] / kTile; j * kTile < box[1] + box[3]; ++j)
    for (int i = box[0] / kTile; i * kTile < box[0] + box[2]; ++i) m_wet_tiles[std::size_t(j) * columns + i] = 1;
}

/// Neighbours in a row become one rectangle.
void GlBackend::pack_tiles() {
  const int columns = (m_scene.width + kTile - 1) / kTile, rows = (m_scene.height + kTile - 1) / kTile;
  const float w = float(m_scene.width), h = float(m_scene.height);
  m_tile_rows.clear();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (!m_wet_tiles[std::size_t(j) * columns + i]) continue;
      const int first = i;
      while (i + 1 < columns && m_wet_tiles[std::size_t(j) * columns + i + 1]) ++i;
      const float tile[4] = {float(first * kTile) / w, float(j * kTile) / h,
                             float(std::min((i + 1) * kTile, m_scene.width)) / w,
                             float(std::min((j + 1) * kTile, m_scene.height)) / h};
      m_tile_rows.insert(m_tile_rows.end(), tile, tile + 4);
    }
}

void GlBackend::pack_splats(const Frame& frame, int field_height) {
  m_splat_rows.clear();
  const int columns = (m_scene.width + kTile - 1) / kTile, rows = (m_scene.height + kTile - 1) / kTile;
  m_wet_tiles.assign(std::size_t(columns) * rows, 0);
  Bounds2 bounds;
  for (const Splat& s : frame.liquid.splats) {
    const Vec3f a = transform_point(m_view, s.from), b = transform_point(m_view, s.to);
    const float near = frame.camera.near_plane;
    if (-a.z < near || -b.z < near || -a.z > frame.camera.far_plane) continue;
    const float texel = -a.z * 2 / (m_projection.m[5] * float(field_height));
    const float radius = std::max(s.radius, kLeastTexel * texel);
    const bool flies = s.kind == SplatKind::flying || s.kind == SplatKind::streak;
    const Vec3f n = flies ? Vec3f{} : transform_direction(m_view, s.normal);
    // Liquid on a surface that turns away from the eye is behind it.
    if (!flies && !s.sheer && dot(n, a) > 0) continue;
    const float thin = s.kind == SplatKind::lying ? 1.0f : s.radius / radius;
    // An outline wanders by a millimetre at most, a film has its skirt (splat.vert).
    const float reach = kSplatReach * radius + (s.kind == SplatKind::film ? 0.0018f : 0.001f);
    Bounds2 own;
    own.add(a, reach, m_projection);
    own.add(b, reach, m_projection);
    const std::array<int, 4> box = own.pixels(m_scene.width, m_scene.height);
    if (box[2] == 0 || box[3] == 0) continue;
    bounds.add(own);
    mark_tiles(box);
    const float row[kSplatFloats] = {a.x, a.y, a.z, radius,     b.x,        b.y,        b.z,        s.height * thin,
                                     n.x, n.y, n.z, code_of(s), s.share[0], s.share[1], s.share[2], s.dark};
    m_splat_rows.insert(m_splat_rows.end(), row, row + kSplatFloats);
  }
  m_wet_box = bounds.pixels(m_scene.width, m_scene.height);
  pack_tiles();
}

void GlBackend::splat_pass(const Frame& frame, const Layout& layout) {
  if (frame.liquid.splats.empty()) return;
  const int part = wet_part(frame.quality);
  const int width = (m_scene.width + part - 1) / part, height = (m_scene.height + part - 1) / part;
  const bool anew = !m_wet[0].colour || m_wet[0].width != width || m_wet[0].height != height;
  for (GlPicture& picture : m_wet) picture.resize(width, height, GL_RGBA16F, false, GL_LINEAR);
  m_wet[0].bind();
  if (anew)
    for (GLenum k = 1; k < 3; ++k)
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + k, GL_TEXTURE_2D, m_wet[k].colour.id(), 0);
  const GLenum all[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(3, all);
  pack_splats(frame, height);
  if (m_splat_rows.empty() || m_wet_box[2] == 0 || m_wet_box[3] == 0) return;

  bind_splats();
  m_wet[0].bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  GlProgram& program = m_programs.get("splat.vert", "splat.frag");
  program.use();
  program.set("u_projection", m_projection);
  program.set("u_scene", kUnitPicture);
  program.set("u_part", part);
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, splat_count());
  glDisable(GL_BLEND);
  wet_pass(frame, layout);
}

void GlBackend::bind_splats() {
  if (!m_splat_buffer) {
    m_splat_layout = new_vertex_array();
    m_splat_buffer = new_buffer();
    glBindVertexArray(m_splat_layout.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_splat_buffer.id());
    for (GLuint k = 0; k < 4; ++k) attribute(k, 4, kSplatFloats, 4 * k, 1);
  }
  glBindVertexArray(m_splat_layout.id());
  glBindBuffer(GL_ARRAY_BUFFER, m_splat_buffer.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(m_splat_rows.size() * sizeof(float)), m_splat_rows.data(), GL_STREAM_DRAW);
}

GLsizei GlBackend::splat_count() const { return GLsizei(m_splat_rows.size() / kSplatFloats); }

/// Only pixels that liquid reaches pass the stencil's test afterwards.
void GlBackend::mark_wet() {
  GlProgram& program = m_programs.get("tile.vert", "wet_mark.frag");
  program.use();
  program.set("u_field", kUnitWet);
  glEnable(GL_STENCIL_TEST);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glStencilFunc(GL_ALWAYS, kStencilWet, kStencilWet);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  draw_tiles();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glStencilFunc(GL_EQUAL, kStencilWet, kStencilWet);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);  // what writes nothing is tested before it is shaded
}

void GlBackend::bind_tiles() {
  if (!m_tile_buffer) {
    m_tile_layout = new_vertex_array();
    m_tile_buffer = new_buffer();
    glBindVertexArray(m_tile_layout.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_tile_buffer.id());
    attribute(0, 4, 4, 0, 1);
  }
  glBindVertexArray(m_tile_layout.id());
  glBindBuffer(GL_ARRAY_BUFFER, m_tile_buffer.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(m_tile_rows.size() * sizeof(float)), m_tile_rows.data(), GL_STREAM_DRAW);
}

void GlBackend::draw_tiles() const { glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(m_tile_rows.size() / 4)); }

void GlBackend::wet_pass(const Frame& frame, const Layout&) {
  keep_bed();
  bind_tiles();
  for (int k = 0; k < 3; ++k) bind_texture(kUnitWet + k, GL_TEXTURE_2D, m_wet[std::size_t(k)].colour.id());
  mark_wet();
  GlProgram& program = m_programs.get("tile.vert", "wet.frag", "DETAIL=" + std::to_string(frame.quality.detail));
  program.use();
  set_liquid(frame, program);
  const char* names[3] = {"u_field", "u_thickness", "u_film"};
  for (int k = 0; k < 3; ++k) program.set(names[k], kUnitWet + k);
  program.set("u_part", float(wet_part(frame.quality)));
  program.set("u_texel", 1.0f / float(m_wet[0].width), 1.0f / float(m_wet[0].height));
  draw_tiles();
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

}  // namespace trocar::render
