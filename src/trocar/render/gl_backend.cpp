// The backend that draws. on_frame is the list of passes; each is one function below it.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <epoxy/gl.h>

#include <trocar/render/checked_backend.hpp>
#include <trocar/render/gl_context.hpp>
#include <trocar/render/gl_meshes.hpp>
#include <trocar/render/gl_program.hpp>
#include <trocar/render/gl_targets.hpp>
#include <trocar/render/patterns.hpp>

namespace trocar::render {

namespace {

enum TextureUnit : int {
  kUnitPicture = 0,
  kUnitNoise = 1,
  kUnitCells = 2,
  kUnitVessels = 3,
  kUnitSmall = 4,
  kUnitSmaller = 5,
  kUnitExposure = 6,
  kUnitArcade = 7,
  kUnitShade = 8
};
constexpr int kEyes = 8;
constexpr float kShadowSpread = 1.8f;  // as in shade.glsl
constexpr float kRodReach = 0.008f;    // [m] beside a rod, as far as it shades
constexpr float kFoldReach = 0.015f;   // [m] from a fold's box, as far as a rod may be to shade it

void bind_texture(int unit, GLenum target, GLuint texture) {
  glActiveTexture(GLenum(GL_TEXTURE0 + unit));
  glBindTexture(target, texture);
}

GlTexture volume_texture(const Pattern& pattern) {
  GlTexture texture = new_texture();
  glBindTexture(GL_TEXTURE_3D, texture.id());
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, pattern.size, pattern.size, pattern.size, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               pattern.texels.data());
  glGenerateMipmap(GL_TEXTURE_3D);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(GL_TEXTURE_3D, axis, GL_REPEAT);
  return texture;
}

GlTexture plane_texture(const Pattern& pattern) {
  GlTexture texture = new_texture();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  const int rows = pattern.rows > 0 ? pattern.rows : pattern.size;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG8, pattern.size, rows, 0, GL_RG, GL_UNSIGNED_BYTE, pattern.texels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  if (pattern.rows > 0) glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

/// Rows of u_material in surface.frag.
std::array<float, 14 * 4> packed(const Material& m) {
  const float noise = 1 / (kNoiseFeatures * m.mottle_size);
  const float rough = m.roughness * m.roughness;
  const float cells = m.lobule_size > 0 ? 1 / (kCellFeatures * m.lobule_size) : 0;
  return {m.colour.x,
          m.colour.y,
          m.colour.z,
          m.mottle,
          m.colour_b.x,
          m.colour_b.y,
          m.colour_b.z,
          noise,
          m.colour_c.x,
          m.colour_c.y,
          m.colour_c.z,
          m.bump,
          m.tint.x,
          m.tint.y,
          m.tint.z,
          m.wetness,
          m.fibre_axis.x,
          m.fibre_axis.y,
          m.fibre_axis.z,
          1 - 1 / m.fibre_stretch,
          m.vessel_colour.x,
          m.vessel_colour.y,
          m.vessel_colour.z,
          m.vessels,
          m.wrap.x,
          m.wrap.y,
          m.wrap.z,
          1 / m.vessel_tile,
          m.glow.x,
          m.glow.y,
          m.glow.z,
          m.glow_amount,
          rough * rough,
          m.film_roughness * m.film_roughness,
          1 / (kNoiseFeatures * m.film_size),
          m.film_bump,
          m.fresnel,
          m.alpha,
          m.rim_alpha,
          m.density,
          cells,
          m.lobule_depth,
          m.lobule_contrast,
          0};
}

/// Whether the film's ripples are about as large as the fine flecks, so that one noise fetch can serve both.
bool film_serves_as_fine(const Material& m) {
  const float ratio = m.film_size / (0.2f * m.mottle_size);
  return m.shading != Shading::metal && ratio > 0.4f && ratio < 2.5f;
}

/// Rows of u_frame in common.glsl.
std::array<float, 8 * 4> packed(const Frame& frame) {
  const Light& l = frame.light;
  const Vec3f bounce = l.bounce * l.bounce_colour;
  const Vec3f fog = frame.look.fog_colour;
  return {l.position.x, l.position.y,
          l.position.z, l.intensity,
          l.colour.x,   l.colour.y,
          l.colour.z,   l.reference_distance * l.reference_distance,
          bounce.x,     bounce.y,
          bounce.z,     l.inverse_square ? 1.0f : 0.0f,
          fog.x,        fog.y,
          fog.z,        frame.look.fog,
          l.ambient,    0,
          l.ring};
}

/// Where the view's circle lies and how large the scene picture is, in pixels of the target.
struct Layout {
  float centre_x, centre_y;
  float radius;          ///< of the mask's circle; without a mask half the diagonal
  int box_w, box_h;      ///< the part of the target that the scene is drawn for, around the centre
  int scene_w, scene_h;  ///< texels of the scene picture

  Layout(const Target& target, const EndoscopeLook& look, float scale) {
    centre_x = float(target.x) + 0.5f * float(target.width);
    centre_y = float(target.y) + 0.5f * float(target.height);
    box_w = target.width;
    box_h = target.height;
    if (look.mask) {
      radius = 0.5f * look.mask_diameter * float(target.height);
      const int side = int(std::ceil(2 * radius));
      box_w = std::max(1, std::min(box_w, side));
      box_h = std::max(1, std::min(box_h, side));
    } else {
      radius = 0.5f * std::sqrt(float(box_w) * float(box_w) + float(box_h) * float(box_h));
    }
    scene_w = std::max(1, int(scale * float(box_w) + 0.5f));
    scene_h = std::max(1, int(scale * float(box_h) + 0.5f));
  }
};

class GlBackend final : public CheckedBackend {
 public:
  explicit GlBackend(GlContext& context) {
    context.make_current();
    m_noise = volume_texture(noise_pattern());
    m_cells = volume_texture(cell_pattern());
    m_vessels = plane_texture(vessel_pattern());
    m_arcade = plane_texture(arcade_pattern());
    m_no_vertices = new_vertex_array();
  }

 private:
  void on_store(std::uint32_t id, const MeshArrays& mesh) override { m_meshes.store(id, mesh); }
  void on_update(std::uint32_t id, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                 std::span<const Paint> paint) override {
    m_meshes.update(id, positions, normals, paint);
  }
  void on_destroy(std::uint32_t id) override { m_meshes.destroy(id); }

  /// Draws each item once at every detail, clean and stained, into a picture of a few pixels.
  void on_prepare(std::span<const DrawItem> items) override {
    for (const Quality& quality : {Quality{1, 2}, Quality{1, 1}, Quality{1, 0}}) {
      Frame frame;
      frame.quality = quality;
      frame.rods = {Rod{{0, 0, -0.01f}, {0, 0, -0.02f}}};  // instruments are in view in most frames
      const Target target = Target::off_screen(8, 8);
      const Layout layout(target, frame.look, 1);
      begin_scene(frame, target, layout);
      for (bool blended : {false, true}) {
        set_blending(blended);
        for (const DrawItem& item : items)
          if (item.translucent == blended)
            for (bool stained : {false, true}) draw_item(frame, item, blended, stained);
      }
      set_blending(false);
      shade_pass(frame, layout);
      shrink_pass();
      develop_pass(frame, layout);
      lens_pass(frame, target, layout);
    }
    m_small_eye = -1;
    leave_state_clean();
  }

  void on_frame(const Frame& frame, const Target& target, std::span<const DrawItem* const> opaque,
                std::span<const DrawItem* const> translucent) override {
    const Layout layout(target, frame.look, frame.quality.render_scale);
    begin_scene(frame, target, layout);
    if (frame.look.mask) mask_pass(layout);
    scene_pass(frame, opaque, false);
    scene_pass(frame, translucent, true);
    puff_pass(frame);
    shade_pass(frame, layout);
    shrink_pass();
    m_small_eye = frame.eye;
    meter_pass(frame, target, layout);
    develop_pass(frame, layout);
    lens_pass(frame, target, layout);
    leave_state_clean();
  }

  void begin_scene(const Frame& frame, const Target& target, const Layout& layout) {
    m_scene.resize(layout.scene_w, layout.scene_h, GL_RGBA16F, true, GL_LINEAR);
    m_scene.bind();
    const Camera& camera = frame.camera;
    m_view = view_matrix(camera.rotation, camera.position);
    const float part = float(layout.box_h) / float(target.height);
    const float fov = 2 * std::atan(part * std::tan(camera.vertical_fov / 2));
    m_projection = perspective(fov, float(layout.box_w) / float(layout.box_h), camera.near_plane, camera.far_plane);
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
    // Mirrors show the picture before, if it was of the same view.
    const bool same_view = m_small.colour && m_small_eye == frame.eye;
    bind_texture(kUnitSmall, GL_TEXTURE_2D, same_view ? m_small.colour.id() : 0);
    m_frame_rows[17] = same_view ? 1.0f : 0.0f;
  }

  /// Rods in the eye's frame, as rows of u_rods: one end and the radius, the way to the other end and 1 / its square.
  void pack_rods(const Frame& frame) {
    m_rod_count = frame.quality.detail > 0 ? std::min(int(frame.rods.size()), kMaxRods) : 0;
    for (int i = 0; i < m_rod_count; ++i) {
      const Rod& rod = frame.rods[std::size_t(i)];
      const Vec3f a = transform_point(m_view, rod.from), way = transform_point(m_view, rod.to) - a;
      const float rows[8] = {a.x, a.y, a.z, rod.radius, way.x, way.y, way.z, 1 / std::max(dot(way, way), 1e-9f)};
      std::copy(std::begin(rows), std::end(rows), m_rod_rows.begin() + 8 * i);
    }
  }

  /// Near depth outside the circle, so that early depth tests drop those pixels.
  void mask_pass(const Layout& layout) {
    GlProgram& program = m_programs.get("mask.vert", "mask.frag");
    program.use();
    program.set("u_radius", 2 * layout.radius / float(layout.box_w), 2 * layout.radius / float(layout.box_h));
    glDisable(GL_CULL_FACE);
    glBindVertexArray(m_no_vertices.id());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * 97);
  }

  /// Translucent things and smoke: premultiplied light over what is there; alpha keeps the opaque distance.
  static void set_blending(bool on) {
    if (on)
      glEnable(GL_BLEND);
    else
      glDisable(GL_BLEND);
    glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthMask(on ? GL_FALSE : GL_TRUE);
  }

  /// Metal is marked in the stencil: instruments do not shade themselves.
  void scene_pass(const Frame& frame, std::span<const DrawItem* const> items, bool blended) {
    set_blending(blended);
    if (!blended) glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    for (const DrawItem* item : items) {
      glStencilFunc(GL_ALWAYS, item->material.shading == Shading::metal ? 1 : 0, 1);
      draw_item(frame, *item, blended, is_stained(item->mesh));
    }
    glDisable(GL_STENCIL_TEST);
    set_blending(false);
  }

  /// Only the rods that come near a fold: each costs at every one of its pixels.
  void set_rods_near(const Frame& frame, const DrawItem& item, GlProgram& program) {
    const Bounds& box = bounds_of_mesh(item.mesh);
    std::array<float, 8 * kMaxRods> rows{};
    int count = 0;
    for (int i = 0; i < m_rod_count; ++i) {
      const Rod& rod = frame.rods[std::size_t(i)];
      bool near = false;
      for (int k = 0; k <= 24 && !near; ++k) {
        const Vec3f p = rod.from + (float(k) / 24) * (rod.to - rod.from);
        float d2 = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const float off = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0f});
          d2 += off * off;
        }
        near = d2 < kFoldReach * kFoldReach;
      }
      if (!near) continue;
      std::copy_n(m_rod_rows.begin() + 8 * i, 8, rows.begin() + 8 * count);
      ++count;
    }
    program.set("u_rod_count", count);
    if (count > 0) program.set_vec4s("u_rods", std::span(rows).first(std::size_t(8 * count)));
  }

  /// The corners, in clip space, of what a rod may shade: around its picture, and as far as its shadow may lie off it.
  std::array<float, 8> reach_of(int rod, float aspect, float tan_half) const {
    const float* row = &m_rod_rows[std::size_t(8 * rod)];
    Vec3f a{row[0], row[1], row[2]}, b = a + Vec3f{row[4], row[5], row[6]};
    constexpr float kNear = 0.008f;  // [m]
    if (a.z > -kNear) std::swap(a, b);
    if (a.z > -kNear) return {};  // beside or behind the lens, and so its shadow
    if (b.z > -kNear) b = a + ((-kNear - a.z) / (b.z - a.z)) * (b - a);
    const auto at = [&](Vec3f p) { return std::array<float, 2>{p.x / (-p.z * tan_half), p.y / (-p.z * tan_half)}; };
    const auto margin = [&](Vec3f p) { return (row[3] + kRodReach) / (std::max(-p.z - 0.006f, 0.004f) * tan_half); };
    const std::array<float, 2> p = at(a), q = at(b);
    const float dx = q[0] - p[0], dy = q[1] - p[1], length = std::max(std::sqrt(dx * dx + dy * dy), 1e-6f);
    const float ex = dx / length, ey = dy / length, m = margin(a), n = margin(b);
    return {
        (p[0] - m * (ex - ey)) / aspect, p[1] - m * (ey + ex), (q[0] + n * (ex + ey)) / aspect, q[1] + n * (ey - ex),
        (p[0] - m * (ex + ey)) / aspect, p[1] - m * (ey - ex), (q[0] + n * (ex - ey)) / aspect, q[1] + n * (ey + ex)};
  }

  /// What instruments leave of the light on opaque surfaces, each over the part of the picture that it may shade.
  void shade_pass(const Frame& frame, const Layout& layout) {
    if (m_rod_count == 0) return;
    m_shade.resize(layout.scene_w, layout.scene_h, GL_RGBA8, false, GL_NEAREST);
    m_shade.bind();
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, m_scene.depth.id());
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_DST_COLOR, GL_ZERO);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_FALSE);
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glStencilFunc(GL_EQUAL, 0, 1);
    glDisable(GL_CULL_FACE);
    GlProgram& program = m_programs.get("shade.vert", "shade.frag");
    program.use();
    bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
    program.set("u_scene", kUnitPicture);
    const Vec3f lamp = kShadowSpread * frame.light.position;
    program.set("u_lamp", lamp.x, lamp.y, lamp.z, frame.light.ring);
    const float tan_y = 1 / m_projection.m[5], tan_x = 1 / m_projection.m[0];
    program.set("u_tan", tan_x, tan_y);
    glBindVertexArray(m_no_vertices.id());
    for (int i = 0; i < m_rod_count; ++i) {
      const float* row = &m_rod_rows[std::size_t(8 * i)];
      program.set("u_rod", row[0], row[1], row[2], row[3]);
      program.set("u_way", row[4], row[5], row[6], row[7]);
      program.set_vec4s("u_corners", reach_of(i, tan_x / tan_y, tan_y));
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LEQUAL);
  }

  void draw_item(const Frame& frame, const DrawItem& item, bool blended, bool stained) {
    const Material& material = item.material;
    const bool two_sided = blended || material.two_sided;
    GlProgram& program = program_for(frame, item.material, blended, stained);
    program.use();
    program.set("u_model_view", m_view * item.transform);
    program.set("u_projection", m_projection);
    program.set_vec4s("u_frame", m_frame_rows);
    if (material.shading == Shading::vertex_colour || material.shading == Shading::unlit) {
      program.set("u_tone", 1, 1, 1, material.alpha);
    } else {
      program.set_vec4s("u_material", packed(material));
      program.set("u_noise", kUnitNoise);
      program.set("u_cells", kUnitCells);
      program.set("u_vessels", material.arcade ? kUnitArcade : kUnitVessels);
      program.set("u_before", kUnitSmall);
      if (blended && m_rod_count > 0) set_rods_near(frame, item, program);
    }
    program.set("u_blended", blended ? 1.0f : 0.0f);
    if (two_sided || m_meshes.is_lines(item.mesh.id))
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    m_meshes.draw(item.mesh.id);
  }

  GlProgram& program_for(const Frame& frame, const Material& material, bool blended, bool stained) {
    const int detail = frame.quality.detail;
    if (material.shading == Shading::unlit) return m_programs.get("flat.vert", "flat.frag");
    if (material.shading == Shading::vertex_colour) return m_programs.get("flat.vert", "flat.frag", "LIT");
    std::string defines = "SHADING=" + std::to_string(int(material.shading)) + ",DETAIL=" + std::to_string(detail);
    const bool tissue = material.shading == Shading::tissue;
    if (detail > 1 && !film_serves_as_fine(material)) defines += ",FINE";
    if (tissue && material.vessels > 0 && detail > 0) defines += material.arcade ? ",VESSELS,ARCADE" : ",VESSELS";
    if (tissue && material.lobule_size > 0) defines += ",LOBULES";
    if (stained) defines += ",STAINED";
    if (frame.look.fog > 0) defines += ",FOGGY";
    if (tissue && blended && m_rod_count > 0) defines += ",RODS";
    if (blended || material.two_sided) defines += ",TWO_SIDED";
    return m_programs.get("surface.vert", "surface.frag", defines);
  }

  void puff_pass(const Frame& frame) {
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
    set_blending(true);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(m_no_vertices.id());
    for (const SeenPuff& seen : m_puffs) {
      const Puff& puff = *seen.puff;
      program.set("u_puff", seen.eye.x, seen.eye.y, seen.eye.z, puff.radius);
      // Its own curls, carried along: the pattern belongs to the place it came from only as far as it moves slowly.
      program.set("u_look", puff.density, 3 * puff.centre.x, 3 * puff.centre.y, 3 * puff.centre.z + puff.radius);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    set_blending(false);
  }

  void resample(const GlPicture& from, GlPicture& to, const char* spread) {
    to.bind();
    GlProgram& program = m_programs.get("full.vert", "shrink.frag", spread);
    program.use();
    program.set("u_picture", kUnitPicture);
    program.set("u_texel", 1.0f / float(from.width), 1.0f / float(from.height));
    bind_texture(kUnitPicture, GL_TEXTURE_2D, from.colour.id());
    draw_full();
  }

  /// A quarter as wide and high, then smoothed, so that enlarging it shows no steps.
  void shrink(const GlPicture& from, GlPicture& rough, GlPicture& smooth) {
    for (GlPicture* picture : {&rough, &smooth})
      picture->resize((from.width + 3) / 4, (from.height + 3) / 4, GL_RGBA16F, false, GL_LINEAR);
    resample(from, rough, "SPREAD=1.0");
    resample(rough, smooth, "SPREAD=0.75");
  }

  void shrink_pass() {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    bind_texture(kUnitSmall, GL_TEXTURE_2D, 0);
    shrink(m_scene, m_rough[0], m_small);
    shrink(m_small, m_rough[1], m_smaller);
  }

  /// Exposure lives in two pictures of one pixel an eye; this reads one and writes the other.
  void meter_pass(const Frame& frame, const Target& target, const Layout& layout) {
    Memory& memory = m_memory[std::size_t(frame.eye)];
    if (!frame.look.auto_exposure || !frame.metering) return;
    const double seconds = memory.known && frame.tick >= memory.tick ? 1e-3 * double(frame.tick - memory.tick) : 1e9;
    const float lag = float(1 - std::exp(-std::min(seconds, 1e3) / double(frame.look.exposure_seconds)));
    const int next = 1 - memory.current;
    for (GlPicture& picture : m_exposure) picture.resize(kEyes, 1, GL_R32F, false, GL_NEAREST);
    m_exposure[std::size_t(next)].bind();
    glEnable(GL_SCISSOR_TEST);
    glScissor(frame.eye, 0, 1, 1);
    GlProgram& program = m_programs.get("full.vert", "meter.frag");
    program.use();
    program.set("u_picture", kUnitPicture);
    program.set("u_memory", kUnitExposure);
    program.set("u_meter", frame.look.exposure_key, memory.known ? lag : 1.0f, frame.look.exposure_range_ev,
                float(frame.eye));
    const float reach = 0.9f * std::min(layout.radius, 0.5f * float(target.height));
    program.set("u_radius", std::min(0.5f, reach / float(layout.box_w)), std::min(0.5f, reach / float(layout.box_h)));
    bind_texture(kUnitPicture, GL_TEXTURE_2D, m_smaller.colour.id());
    bind_texture(kUnitExposure, GL_TEXTURE_2D, m_exposure[std::size_t(memory.current)].colour.id());
    draw_full();
    glDisable(GL_SCISSOR_TEST);
    memory = {next, frame.tick, true};
  }

  static const char* view_shape(const EndoscopeLook& look) { return look.mask ? "disc.vert" : "full.vert"; }

  void develop_pass(const Frame& frame, const Layout& layout) {
    m_developed.resize(layout.scene_w, layout.scene_h, GL_RGBA8, false, GL_LINEAR);
    m_developed.bind();
    const EndoscopeLook& look = frame.look;
    const Memory& memory = m_memory[std::size_t(frame.eye)];
    const bool effects = frame.quality.detail > 1 && (look.bloom > 0 || look.defocus > 0 || look.contact > 0);
    const bool rods = m_rod_count > 0;
    GlProgram& program = m_programs.get(view_shape(look), "develop.frag",
                                        std::string(effects ? "EFFECTS," : "") + (rods ? "RODS," : ""));
    program.use();
    program.set("u_scene", kUnitPicture);
    program.set("u_small", kUnitSmall);
    program.set("u_smaller", kUnitSmaller);
    program.set("u_exposure", kUnitExposure);
    program.set("u_rod_shade", kUnitShade);
    if (rods) bind_texture(kUnitShade, GL_TEXTURE_2D, m_shade.colour.id());
    const bool remembered = look.auto_exposure && memory.known;
    program.set("u_camera", look.exposure_ev, remembered ? float(frame.eye) : -1.0f, look.bloom, look.saturation);
    program.set("u_place", layout.radius / float(layout.box_w), layout.radius / float(layout.box_h), look.vignette, 0);
    program.set("u_depth", look.focus_near, look.defocus, look.contact, 2 * std::tan(frame.camera.vertical_fov / 2));
    const Vec3f lamp = frame.light.position;
    const float off = std::max(1e-6f, std::sqrt(lamp.x * lamp.x + lamp.y * lamp.y));
    const float aspect = float(layout.box_h) / float(layout.box_w);
    const Vec3f to_lamp = off > 1e-5f ? Vec3f{lamp.x / off * aspect, lamp.y / off, 0} : Vec3f{};
    program.set("u_shadow", 0.02f * to_lamp.x, 0.02f * to_lamp.y);
    program.set("u_white", look.white_balance);
    bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
    bind_texture(kUnitSmall, GL_TEXTURE_2D, m_small.colour.id());
    bind_texture(kUnitSmaller, GL_TEXTURE_2D, m_smaller.colour.id());
    bind_texture(kUnitExposure, GL_TEXTURE_2D, m_exposure[std::size_t(memory.current)].colour.id());
    draw_view(program, look, layout.radius, float(layout.box_w), float(layout.box_h));
  }

  void lens_pass(const Frame& frame, const Target& target, const Layout& layout) {
    bind_target(target);
    const EndoscopeLook& look = frame.look;
    std::string defines;
    if (look.fringe_px > 0 && frame.quality.detail > 1) defines += "FRINGE,";
    if (frame.quality.detail > 0) defines += "SMOOTH,";
    GlProgram& program = m_programs.get(view_shape(look), "lens.frag", defines);
    program.use();
    program.set("u_picture", kUnitPicture);
    program.set("u_place", layout.centre_x, layout.centre_y, layout.radius, look.mask ? 1.0f : 0.0f);
    program.set("u_box", float(layout.box_w), float(layout.box_h), 1.0f / float(layout.box_w),
                1.0f / float(layout.box_h));
    program.set("u_texel", 1.0f / float(layout.scene_w), 1.0f / float(layout.scene_h));
    program.set("u_lens", look.barrel, look.fringe_px * float(target.height) / 600.0f,
                look.sharpen * frame.quality.render_scale, std::max(look.mask_soft_px, 0.5f));
    program.set("u_sensor", look.noise, look.notch, std::sin(look.notch_angle), std::cos(look.notch_angle));
    program.set_seed("u_seed", std::uint32_t(frame.tick * 2654435761u));
    bind_texture(kUnitPicture, GL_TEXTURE_2D, m_developed.colour.id());
    draw_view(program, look, layout.radius, float(target.width), float(target.height));
  }

  void bind_target(const Target& target) {
    if (target.framebuffer == Target::kOwnBuffer) {
      m_own.resize(target.width, target.height, GL_RGBA8, false, GL_NEAREST);
      m_own.bind();
    } else {
      glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    }
    glViewport(target.x, target.y, target.width, target.height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(target.x, target.y, target.width, target.height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
  }

  void draw_full() {
    glBindVertexArray(m_no_vertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  /// Only the endoscope's circle of a picture that it is centred in; without a mask all of it.
  void draw_view(GlProgram& program, const EndoscopeLook& look, float radius, float width, float height) {
    if (!look.mask) return draw_full();
    program.set("u_radius", 2 * radius / width, 2 * radius / height);
    glBindVertexArray(m_no_vertices.id());
    glDrawArrays(GL_TRIANGLE_FAN, 0, 98);
  }

  /// Others draw into the same context (menus): leave nothing bound that they would trip over.
  void leave_state_clean() {
    glBindVertexArray(0);
    glUseProgram(0);
    glActiveTexture(GL_TEXTURE0);
  }

  Image on_read(const Target& target) override {
    if (target.framebuffer == Target::kOwnBuffer)
      m_own.bind();
    else
      glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    Image image{target.width, target.height, {}};
    std::vector<std::uint8_t> rgba(std::size_t(4) * target.width * target.height);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(target.x, target.y, target.width, target.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    image.rgb.resize(std::size_t(3) * target.width * target.height);
    for (int y = 0; y < target.height; ++y)
      for (int x = 0; x < target.width; ++x)
        for (int c = 0; c < 3; ++c)
          image.rgb[3 * (std::size_t(y) * target.width + x) + c] =
              rgba[4 * (std::size_t(target.height - 1 - y) * target.width + x) + c];
    return image;
  }

  struct SeenPuff {
    Vec3f eye;
    const Puff* puff;
  };
  struct Memory {
    int current = 0;         ///< which of m_exposure holds this eye's value
    std::uint64_t tick = 0;  ///< when it was written
    bool known = false;
  };

  GlMeshes m_meshes;
  GlPrograms m_programs;
  GlTexture m_noise, m_cells, m_vessels, m_arcade;
  GlVertexArray m_no_vertices;
  GlPicture m_scene, m_shade, m_small, m_smaller, m_developed, m_own;
  std::array<GlPicture, 2> m_rough, m_exposure;
  std::array<Memory, kEyes> m_memory;
  Mat4 m_view, m_projection;
  std::array<float, 8 * 4> m_frame_rows{};
  std::array<float, 8 * kMaxRods> m_rod_rows{};
  int m_rod_count = 0;
  std::vector<SeenPuff> m_puffs;
  int m_small_eye = -1;  ///< whose picture m_small holds
};

}  // namespace

std::unique_ptr<Backend> make_gl_backend(GlContext& context) { return std::make_unique<GlBackend>(context); }

}  // namespace trocar::render
