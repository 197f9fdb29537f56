// The backend that draws. passes() is the list of what a frame goes through; each is one function in the files beside
// this one.
#include <string>

#include <trocar/core/error.hpp>
#include <trocar/render/gl/gl_backend_parts.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/render/meshes/patterns.hpp>

namespace trocar::render {
namespace {

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

}  // namespace

GlBackend::GlBackend(GlContext& context) : m_context(context) {
  context.make_current();
  m_noise = volume_texture(noise_pattern());
  m_cells = volume_texture(cell_pattern());
  m_vessels = plane_texture(vessel_pattern());
  m_arcade = plane_texture(arcade_pattern());
  m_lining = plane_texture(lining_pattern());
  m_no_vertices = new_vertex_array();
}

void GlBackend::on_prepare(std::span<const DrawItem> items) {
  for (const Quality& quality : {Quality{1, 2, 1, 4}, Quality{1, 2}, Quality{1, 1}, Quality{1, 0}}) {
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
    resolve_pass(frame);
    m_smokes = false;
    shade_pass(frame, layout);
    shrink_pass();
    develop_pass(frame, target, layout);
    lens_pass(frame, target, layout);
  }
  m_small_eye = -1;
  leave_state_clean();
}

void GlBackend::on_prepare_liquids() {
  Frame frame;
  frame.look.auto_exposure = false;
  Splat drop;
  drop.from = drop.to = {0, 0, -0.05f};
  frame.liquid.splats = {drop};
  for (int k = 0; k < 3; ++k) {
    SheetVertex corner;
    corner.position = {0.01f * float(k % 2), 0.01f * float(k / 2), -0.05f};
    corner.normal = {0, 0, 1};
    corner.depth = 0.001f, corner.cover = 1;
    frame.liquid.sheet.push_back(corner);
  }
  frame.liquid.triangles = {0, 1, 2};
  frame.smoke.nx = frame.smoke.ny = frame.smoke.nz = 2;
  frame.smoke.density.assign(8, 1.0f);
  for (const int detail : {2, 1, 0})
    for (int soil = 0; soil < 4; ++soil) {  // fogged; wiped; smeared; with drops
      frame.quality.detail = detail;
      frame.look.soil = {};
      frame.look.soil.fog = 0.5f;
      if (soil == 1) frame.look.soil.wipe = 0.5f;
      if (soil == 2) frame.look.soil.smear = 0.5f;
      if (soil == 3) frame.look.soil.drop_count = 1;
      on_frame(frame, Target::off_screen(8, 8), {}, {});
    }
  m_small_eye = -1;
}

std::span<const GlBackend::Pass> GlBackend::passes() {
  static constexpr Pass list[] = {
      {"clear", [](GlBackend& b, const Drawing& d) { b.begin_scene(d.frame, d.target, d.layout); }},
      {"mask",
       [](GlBackend& b, const Drawing& d) {
         if (d.frame.look.mask) b.mask_pass(d.layout);
       }},
      {"opaque", [](GlBackend& b, const Drawing& d) { b.scene_pass(d.frame, d.opaque, false); }},
      // Sample by sample: behind an outline's pixels a fold would be missing whole, and what is dark behind it be seen.
      {"translucent", [](GlBackend& b, const Drawing& d) { b.scene_pass(d.frame, d.translucent, true); }},
      {"smooth edges", [](GlBackend& b, const Drawing& d) { b.resolve_pass(d.frame); }},
      {"pool", [](GlBackend& b, const Drawing& d) { b.sheet_pass(d.frame, d.layout); }},
      // A pool needs the scene resolved, and hides what is before it: that once more.
      {"translucent before a pool",
       [](GlBackend& b, const Drawing& d) {
         if (!d.frame.liquid.triangles.empty()) b.before_pool_pass(d.frame, d.translucent);
       }},
      {"drops and films", [](GlBackend& b, const Drawing& d) { b.splat_pass(d.frame, d.layout); }},
      {"puffs", [](GlBackend& b, const Drawing& d) { b.puff_pass(d.frame); }},
      {"smoke", [](GlBackend& b, const Drawing& d) { b.smoke_pass(d.frame); }},
      {"shadows", [](GlBackend& b, const Drawing& d) { b.shade_pass(d.frame, d.layout); }},
      {"shrink", [](GlBackend& b, const Drawing&) { b.shrink_pass(); }},
      {"metering",
       [](GlBackend& b, const Drawing& d) {
         b.m_small_eye = d.frame.eye;
         b.meter_pass(d.frame, d.target, d.layout);
       }},
      {"developing", [](GlBackend& b, const Drawing& d) { b.develop_pass(d.frame, d.target, d.layout); }},
      {"dirt",
       [](GlBackend& b, const Drawing& d) {
         if (!d.frame.look.soil.clean()) b.soil_pass();
       }},
      {"lens", [](GlBackend& b, const Drawing& d) { b.lens_pass(d.frame, d.target, d.layout); }},
  };
  return list;
}

void GlBackend::on_frame(const Frame& frame, const Target& target, std::span<const DrawItem* const> opaque,
                         std::span<const DrawItem* const> translucent) {
  if (m_context.lost())
    throw core::EnvironmentLacks(
        "the graphics driver was reset and has lost the picture: start Trocar again; what was done is in the "
        "recording");
  const Drawing drawing{frame, target, Layout(target, frame.look, frame.quality.render_scale), opaque, translucent};
  for (const Pass& pass : passes()) {
    if (costs()) m_timer.start();
    pass.run(*this, drawing);
    if (costs()) costs()->push_back(m_timer.stop(pass.name));
  }
  leave_state_clean();
}

void GlBackend::bind_target(const Target& target) {
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

void GlBackend::leave_state_clean() {
  glBindVertexArray(0);
  glUseProgram(0);
  glActiveTexture(GL_TEXTURE0);
}

void GlBackend::on_keep_eye(Eye eye, const Target& from) {
  GlPicture& kept = eye == Eye::left ? m_left : m_right;
  kept.resize(from.width, from.height, GL_RGBA8, false, GL_LINEAR);
  const bool own = from.framebuffer == Target::kOwnBuffer;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, own ? m_own.framebuffer.id() : from.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, kept.framebuffer.id());
  glBlitFramebuffer(from.x, from.y, from.x + from.width, from.y + from.height, 0, 0, from.width, from.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void GlBackend::on_combine(StereoMode mode, const Target& target) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  if (mode == StereoMode::quad_buffer) {
    for (const bool right : {false, true}) {
      bind_target(target);
      glDrawBuffer(right ? GL_BACK_RIGHT : GL_BACK_LEFT);
      glBindFramebuffer(GL_READ_FRAMEBUFFER, (right ? m_right : m_left).framebuffer.id());
      glBlitFramebuffer(0, 0, m_left.width, m_left.height, target.x, target.y, target.x + target.width,
                        target.y + target.height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    }
    glDrawBuffer(GL_BACK);
    return leave_state_clean();
  }
  bind_target(target);
  GlProgram& program = m_programs.get("full.vert", "combine.frag", "MODE=" + std::to_string(int(mode)));
  program.use();
  program.set("u_left", kUnitPicture);
  program.set("u_right", kUnitSmall);
  program.set("u_place", float(target.x), float(target.y), float(target.width), float(target.height));
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_left.colour.id());
  bind_texture(kUnitSmall, GL_TEXTURE_2D, m_right.colour.id());
  draw_full();
  leave_state_clean();
}

Image GlBackend::on_read(const Target& target) {
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

std::unique_ptr<Backend> make_gl_backend(GlContext& context) { return std::make_unique<GlBackend>(context); }

}  // namespace trocar::render
