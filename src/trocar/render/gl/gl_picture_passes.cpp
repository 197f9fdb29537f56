#include <algorithm>
#include <cmath>
#include <string>

#include <trocar/core/tick.hpp>
#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {
namespace {

std::string soil_variant(const LensSoil& soil, const Quality& quality) {
  std::string defines = "SOILED,";
  if (quality.detail > 0) defines += "UNEVEN,";
  if (soil.smear > 0 || soil.wipe >= 0) defines += "SMEARED,";
  if (soil.wipe >= 0) defines += "WIPED,";
  if (soil.drop_count > 0) defines += "DROPS,";
  return defines;
}

const char* view_shape(const EndoscopeLook& look) { return look.mask ? "disc.vert" : "full.vert"; }

}  // namespace

void GlBackend::resample(const GlPicture& from, GlPicture& to, const char* spread) {
  to.bind();
  GlProgram& program = m_programs.get("full.vert", "shrink.frag", spread);
  program.use();
  program.set("u_picture", kUnitPicture);
  program.set("u_texel", 1.0f / float(from.width), 1.0f / float(from.height));
  bind_texture(kUnitPicture, GL_TEXTURE_2D, from.colour.id());
  draw_full();
}

void GlBackend::shrink(const GlPicture& from, GlPicture& rough, GlPicture& smooth, GLenum format) {
  for (GlPicture* picture : {&rough, &smooth})
    picture->resize((from.width + 3) / 4, (from.height + 3) / 4, format, false, GL_LINEAR);
  resample(from, rough, "SPREAD=1.0");
  resample(rough, smooth, "SPREAD=0.75");
}

void GlBackend::shrink_pass() {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  bind_texture(kUnitSmall, GL_TEXTURE_2D, 0);
  shrink(m_scene, m_rough[0], m_small);
  shrink(m_small, m_rough[1], m_smaller);
}

void GlBackend::meter_pass(const Frame& frame, const Target& target, const Layout& layout) {
  Memory& memory = m_memory[std::size_t(frame.eye)];
  if (!frame.look.auto_exposure || !frame.metering) return;
  const double seconds =
      memory.known && frame.tick >= memory.tick ? core::kTick * double(frame.tick - memory.tick) : 1e9;
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

void GlBackend::develop_pass(const Frame& frame, const Target& target, const Layout& layout) {
  m_developed.resize(layout.scene_w, layout.scene_h, GL_RGBA8, false, GL_LINEAR);
  m_developed.bind();
  const EndoscopeLook& look = frame.look;
  const Memory& memory = m_memory[std::size_t(frame.eye)];
  const bool effects = frame.quality.detail > 1 && (look.bloom > 0 || look.aperture > 0 || look.contact > 0);
  const bool rods = m_rod_count > 0;
  GlProgram& program = m_programs.get(view_shape(look), "develop.frag",
                                      std::string(effects ? "EFFECTS," : "") + (rods ? "RODS," : "") +
                                          (frame.quality.samples > 1 ? "SAMPLED," : "") + (m_smokes ? "SMOKE," : ""));
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
  const float height = 2 * std::tan(frame.camera.vertical_fov / 2);
  const float lines = float(layout.scene_h) * float(target.height) / float(layout.box_h);
  program.set("u_depth", 1 / look.focus, look.aperture * lines / height, look.contact, height);
  const Vec3f lamp = frame.light.position;
  const float off = std::max(1e-6f, std::sqrt(lamp.x * lamp.x + lamp.y * lamp.y));
  const float aspect = float(layout.box_h) / float(layout.box_w);
  const Vec3f to_lamp = off > 1e-5f ? Vec3f{lamp.x / off * aspect, lamp.y / off, 0} : Vec3f{};
  program.set("u_shadow", 0.02f * to_lamp.x, 0.02f * to_lamp.y);
  program.set("u_white", look.white_balance);
  if (m_smokes) set_smoke(frame.smoke, program);
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
  bind_texture(kUnitSmall, GL_TEXTURE_2D, m_small.colour.id());
  bind_texture(kUnitSmaller, GL_TEXTURE_2D, m_smaller.colour.id());
  bind_texture(kUnitExposure, GL_TEXTURE_2D, m_exposure[std::size_t(memory.current)].colour.id());
  draw_view(program, look, layout.radius, float(layout.box_w), float(layout.box_h));
}

void GlBackend::lens_pass(const Frame& frame, const Target& target, const Layout& layout) {
  bind_target(target);
  const EndoscopeLook& look = frame.look;
  std::string defines;
  if (look.fringe_px > 0 && frame.quality.detail > 1) defines += "FRINGE,";
  if (frame.quality.detail > 0) defines += "SMOOTH,";
  const bool soiled = !look.soil.clean();
  if (soiled) defines += soil_variant(look.soil, frame.quality);
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
  if (soiled) set_soil(look.soil, frame.tick, program);
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_developed.colour.id());
  draw_view(program, look, layout.radius, float(target.width), float(target.height));
}

void GlBackend::soil_pass() {
  glDisable(GL_DEPTH_TEST);
  shrink(m_developed, m_blur_rough[0], m_blur[0], GL_RGBA8);
  shrink(m_blur[0], m_blur_rough[1], m_blur[1], GL_RGBA8);
  shrink(m_blur[1], m_blur_rough[2], m_blur[2], GL_RGBA8);
}

void GlBackend::set_soil(const LensSoil& soil, std::uint64_t tick, GlProgram& program) {
  program.set("u_blur", kUnitSmall);
  program.set("u_blurrer", kUnitSmaller);
  program.set("u_blurred", kUnitBed);
  program.set("u_noise", kUnitNoise);
  bind_texture(kUnitBed, GL_TEXTURE_2D, m_blur[2].colour.id());
  bind_texture(kUnitSmall, GL_TEXTURE_2D, m_blur[0].colour.id());
  bind_texture(kUnitSmaller, GL_TEXTURE_2D, m_blur[1].colour.id());
  bind_texture(kUnitNoise, GL_TEXTURE_3D, m_noise.id());
  program.set("u_soil", soil.fog, soil.smear, std::sin(soil.smear_angle), std::cos(soil.smear_angle));
  program.set("u_smear", soil.smear_tint.x, soil.smear_tint.y, soil.smear_tint.z, soil.wipe);
  program.set("u_swab", soil.swab.x, soil.swab.y, soil.swab.z, float(tick % 100000) * 1e-3f);
  std::array<float, 8 * LensSoil::kMaxDrops> rows{};
  for (int i = 0; i < soil.drop_count; ++i) {
    const LensDrop& drop = soil.drops[std::size_t(i)];
    const float row[8] = {drop.x, drop.y, drop.radius, 0, drop.tint.x, drop.tint.y, drop.tint.z, 0};
    std::copy(row, row + 8, &rows[std::size_t(8 * i)]);
  }
  program.set_vec4s("u_drops", rows);
  program.set("u_drop_count", soil.drop_count);
}

void GlBackend::draw_full() {
  glBindVertexArray(m_no_vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlBackend::draw_view(GlProgram& program, const EndoscopeLook& look, float radius, float width, float height) {
  if (!look.mask) return draw_full();
  program.set("u_radius", 2 * radius / width, 2 * radius / height);
  glBindVertexArray(m_no_vertices.id());
  glDrawArrays(GL_TRIANGLE_FAN, 0, 98);
}

}  // namespace trocar::render
