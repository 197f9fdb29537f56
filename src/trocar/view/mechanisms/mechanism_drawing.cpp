#include <algorithm>
#include <cmath>

#include <trocar/view/mechanisms/mechanism_drawing.hpp>

namespace trocar::view {

using kinematics::BodyShape;
using kinematics::Frame;
using kinematics::Mechanism;
using kinematics::ShapeKind;

namespace {

// Told apart with every kind of colour vision [Okabe & Ito 2008], a little paler.
constexpr painted::Colour kLinkColours[] = {{120, 126, 134}, {86, 160, 211},  {226, 168, 62}, {74, 172, 142},
                                            {205, 130, 170}, {222, 212, 110}, {60, 120, 180}, {206, 112, 62}};
constexpr double kHairline = 0.002;  // of the whole: links without shapes are drawn as lines

int link_of(const Mechanism& m, int body) {
  for (std::size_t l = 0; l < m.link_body.size(); ++l)
    if (m.link_body[l] == body) return int(l);
  return 0;
}

struct Extent {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  void take(Vec3d p, double r) {
    low = {std::min(low.x, p.x - r), std::min(low.y, p.y - r), std::min(low.z, p.z - r)};
    high = {std::max(high.x, p.x + r), std::max(high.y, p.y + r), std::max(high.z, p.z + r)};
  }
};

Extent extent_of(const Mechanism& m, const kinematics::Pose& pose) {
  Extent all;
  for (const BodyShape& s : m.shapes) {
    const Frame& f = pose.frames[std::size_t(s.body)];
    if (s.kind == ShapeKind::box)
      all.take(f * s.from, 0.5 * length(s.to));
    else
      all.take(f * s.from, s.radius), all.take(f * s.to, s.radius);
  }
  for (const Frame& f : pose.frames)
    if (m.shapes.empty()) all.take(f.p, 0.1 * m.length);
  return all;
}

}  // namespace

MechanismDrawing::MechanismDrawing(render::Backend& backend, const Mechanism& m, const kinematics::Pose& pose)
    : m_backend(&backend) {
  const Extent all = extent_of(m, pose);
  m_middle = 0.5 * (all.low + all.high);
  m_scale = 1 / std::max(1e-6, length(all.high - all.low));
  shape(m);
  move(pose);
}

painted::Colour MechanismDrawing::colour_of(int link) const {
  for (const auto& [marked, colour] : m_marked)
    if (marked == link) return colour;
  constexpr int kCount = int(std::size(kLinkColours));
  return link == 0 ? kLinkColours[0] : kLinkColours[1 + (link - 1) % (kCount - 1)];
}

void MechanismDrawing::shape(const Mechanism& m) {
  std::vector<Part> before = std::move(m_parts);
  m_parts.clear();
  for (int body = 0; body < int(m.bodies.size()); ++body) {
    MeshBuffer b;
    const painted::Colour colour = colour_of(link_of(m, body));
    bool any = false;
    for (const BodyShape& s : m.shapes) {
      if (s.body != body) continue;
      any = true;
      const Vec3d from = m_scale * s.from, to = m_scale * s.to;
      if (s.kind == ShapeKind::box)
        painted::add_box(b, from, s.turn, 0.5 * to, 0.1 * std::min({to.x, to.y, to.z}), colour);
      else if (s.kind == ShapeKind::cylinder)
        painted::add_cylinder(b, from, to, m_scale * s.radius, colour);
      else
        painted::add_rod(b, from, to, m_scale * s.radius, m_scale * s.radius, colour);
    }
    // Bodies without a shape: a line from where their parent is.
    const kinematics::Body& it = m.bodies[std::size_t(body)];
    if (!any && it.parent >= 0 && m.shapes.empty())
      painted::add_rod(b, {}, m_scale * kinematics::inverse(m.places[std::size_t(body)]).p, kHairline, kHairline,
                       colour);
    if (b.size() == 0) continue;
    Part part{body, OwnedMesh(*m_backend, b.data()), {}};
    for (const Part& old : before)
      if (old.body == body) part.transform = old.transform;
    m_parts.push_back(std::move(part));
  }
}

void MechanismDrawing::move(const kinematics::Pose& pose) {
  for (Part& part : m_parts) {
    const Frame& f = pose.frames[std::size_t(part.body)];
    Mat3f r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r.m[i][j] = float(f.r.m[i][j]);
    part.transform = render::placement(r, vec_cast<float>(drawn(f.p)));
  }
}

UprightOrbit MechanismDrawing::whole() const {
  UprightOrbit orbit;
  orbit.target = {};
  orbit.yaw = -0.5, orbit.pitch = 0.35, orbit.distance = 1.8;
  return orbit;
}

UprightOrbit MechanismDrawing::about_joints(const Mechanism& m, const kinematics::Pose& pose) const {
  constexpr double kLeastWay = 0.03, kRoom = 2.2;  // of the whole
  Extent all;
  for (std::size_t b = 1; b < pose.frames.size(); ++b) all.take(drawn(pose.frames[b].p), 0);
  for (const kinematics::BodyFrame& f : m.frames) all.take(drawn(kinematics::place(f, pose).p), 0);
  UprightOrbit orbit = whole();
  if (all.high.x < all.low.x) return orbit;
  orbit.target = 0.5 * (all.low + all.high);
  orbit.distance = std::min(orbit.distance, kRoom * std::max(kLeastWay, length(all.high - all.low)));
  return orbit;
}

render::Frame MechanismDrawing::frame(const UprightOrbit& orbit) const {
  render::Frame f;
  f.camera = render::look_at(vec_cast<float>(orbit.eye()), vec_cast<float>(orbit.target), {0, 0, 1});
  f.camera.vertical_fov = 0.62f;
  f.camera.near_plane = float(0.1 * orbit.distance), f.camera.far_plane = 14;
  f.light.position = {-0.9f, 1.3f, 0.6f};  // over the shoulder of who looks
  f.light.colour = {1.0f, 0.99f, 0.97f};
  f.light.inverse_square = false;
  f.light.intensity = 0.55f;
  f.light.bounce = 0.16f;
  f.light.ambient = 0.28f;
  f.look = render::plain_look();
  f.look.auto_exposure = false;
  f.look.contact = 0;
  f.look.exposure_ev = -0.35f;
  f.quality.samples = 4;
  f.background = render::srgb(222, 227, 229);
  for (const Part& part : m_parts) {
    render::DrawItem item;
    item.mesh = part.mesh.handle();
    item.material.shading = render::Shading::vertex_colour;
    item.material.wetness = 1.2f;
    item.material.two_sided = true;
    item.transform = part.transform;
    f.items.push_back(item);
  }
  return f;
}

}  // namespace trocar::view
