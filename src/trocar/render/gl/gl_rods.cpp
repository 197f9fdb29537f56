#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/render/gl/gl_backend_parts.hpp>

namespace trocar::render {
namespace {

constexpr float kShadowSpread = 6.0f;   // as in shade.glsl
constexpr float kRodReach = 0.0035f;    // [m] beside a rod, as far as it shades or pales ...
constexpr float kShadowReach = 0.018f;  // [m] ... and how much further away from the lamp
constexpr float kFoldReach = 0.015f;    // [m] from a fold's box, as far as a rod may be to shade it

}  // namespace

void GlBackend::pack_rods(const Frame& frame) {
  m_rod_count = frame.quality.detail > 0 ? std::min(int(frame.rods.size()), kMaxRods) : 0;
  for (int i = 0; i < m_rod_count; ++i) {
    const Rod& rod = frame.rods[std::size_t(i)];
    const Vec3f a = transform_point(m_view, rod.from), way = transform_point(m_view, rod.to) - a;
    const float rows[8] = {a.x, a.y, a.z, rod.radius, way.x, way.y, way.z, 1 / std::max(dot(way, way), 1e-9f)};
    std::copy(std::begin(rows), std::end(rows), m_rod_rows.begin() + 8 * i);
  }
}

void GlBackend::set_rods_near(const Frame& frame, const DrawItem& item, GlProgram& program) {
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

std::array<float, 8> GlBackend::reach_of(int rod, float aspect, float tan_half) const {
  const float* row = &m_rod_rows[std::size_t(8 * rod)];
  Vec3f a{row[0], row[1], row[2]}, b = a + Vec3f{row[4], row[5], row[6]};
  constexpr float kNear = 0.008f;  // [m]
  if (a.z > -kNear) std::swap(a, b);
  if (a.z > -kNear) return {};  // beside or behind the lens, and so its shadow
  if (b.z > -kNear) b = a + ((-kNear - a.z) / (b.z - a.z)) * (b - a);
  const auto at = [&](Vec3f p) {
    return std::array<float, 2>{(p.x / -p.z - m_shift) / tan_half, p.y / (-p.z * tan_half)};
  };
  const auto part = [&](Vec3f p, float reach) { return reach / (std::max(-p.z - 0.006f, 0.004f) * tan_half); };
  const std::array<float, 2> p = at(a), q = at(b);
  const float dx = q[0] - p[0], dy = q[1] - p[1], length = std::max(std::sqrt(dx * dx + dy * dy), 1e-6f);
  const float ex = dx / length, ey = dy / length;
  const float lamp = std::max(std::hypot(m_frame_rows[0], m_frame_rows[1]), 1e-6f);
  const float away_x = -m_frame_rows[0] / lamp, away_y = -m_frame_rows[1] / lamp;
  // Of one end: how far out along the rod (`out` is -1 or 1) and to its left and right.
  const auto corners = [&](const std::array<float, 2>& from, Vec3f end, float out) {
    const float near = part(end, row[3] + kRodReach), far = part(end, kShadowReach);
    const float along = away_x * ex + away_y * ey, left = away_y * ex - away_x * ey;
    const float end_m = out * (near + far * std::max(0.0f, out * along));
    const float left_m = near + far * std::max(0.0f, left), right_m = near + far * std::max(0.0f, -left);
    const float x = from[0] + end_m * ex, y = from[1] + end_m * ey;
    return std::array<float, 4>{(x - left_m * ey) / aspect, y + left_m * ex, (x + right_m * ey) / aspect,
                                y - right_m * ex};
  };
  const std::array<float, 4> low = corners(p, a, -1), high = corners(q, b, 1);
  return {low[0], low[1], high[0], high[1], low[2], low[3], high[2], high[3]};
}

void GlBackend::shade_pass(const Frame& frame, const Layout& layout) {
  if (m_rod_count == 0) return;
  m_shade.resize(layout.scene_w, layout.scene_h, GL_RGBA8, false, GL_LINEAR);
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
  glStencilFunc(GL_EQUAL, 0, kStencilMetal);
  glDisable(GL_CULL_FACE);
  GlProgram& program = m_programs.get("shade.vert", "shade.frag", frame.quality.samples > 1 ? "SAMPLED" : "");
  program.use();
  bind_texture(kUnitPicture, GL_TEXTURE_2D, m_scene.colour.id());
  program.set("u_scene", kUnitPicture);
  const Vec3f lamp = kShadowSpread * frame.light.position;
  program.set("u_lamp", lamp.x, lamp.y, lamp.z, frame.light.ring);
  const float tan_y = 1 / m_projection.m[5], tan_x = 1 / m_projection.m[0];
  program.set("u_tan", Vec3f{tan_x, tan_y, m_shift});
  glBindVertexArray(m_no_vertices.id());
  for (int i = 0; i < m_rod_count; ++i) {
    const float* row = &m_rod_rows[std::size_t(8 * i)];
    program.set("u_rod", row[0], row[1], row[2], row[3]);
    program.set("u_way", row[4], row[5], row[6], row[7]);
    program.set("u_pressed", frame.rods[std::size_t(i)].pressed);
    program.set_vec4s("u_corners", reach_of(i, tan_x / tan_y, tan_y));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
}

}  // namespace trocar::render
