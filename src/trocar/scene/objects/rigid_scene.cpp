#include <algorithm>
#include <cmath>

#include <trocar/numerics/mat3.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/objects/rigid_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

using interactions::RigidModel;

constexpr double kFar = 2000;          // [mm]
constexpr double kSpacing = 0.8;       // of beads, in radii: a rim of beads is as smooth as a fifth of that lets it be
constexpr double kNearWalls = 0.0025;  // [m] beyond its surface, from which on an object knows of walls
constexpr double kGripSpacing = 0.4;   // of places that jaws hold, in radii

const Shape& rigid_shape() {
  static const Shape shape{
      "rigid object",
      "A body that does not bend: a ring, a thick line of points, or a pebble. It falls, lies on walls and tissue, and "
      "is held by jaws.",
      {needed(keys::name("name", "its name in exercises")), keys::text("look", "its material, default \"plastic\""),
       keys::number("outer_mm", 2, 200, "outer diameter of a ring; a thick line has line_mm instead"),
       keys::points("line_mm", -kFar, kFar, 1, "middles of a thick line, in its own frame"),
       keys::vec3("pebble_mm", 0.5, 50, "diameters of a pebble along its axes, the widest first"),
       keys::number("thick_mm", 0.5, 50, "thickness of a ring or a line"),
       needed(keys::number("mass_g", 0.05, 1000, "")),
       keys::number("friction", 0, 2, "Coulomb's coefficient on walls, instruments and others, default 0.3"),
       keys::vec3("at_mm", -kFar, kFar, "its middle, at the start; needed but for a stone in a pouch"),
       keys::text(
           "in",
           "of a pebble: the pouch that it lies in, until a hole is wide enough for it to fall out; default none"),
       keys::vec3("axis", -1, 1, "of the ring, default (0, 0, 1); of others: their frame's z")}};
  return shape;
}

/// Along a circle about z: `count` beads, and around each cross-section four places to hold.
void make_ring(double outer, RigidModel& m) {
  const double middle = 0.5 * outer - m.radius, around = 2 * portable::pi * middle;
  const int beads = std::max(6, int(std::ceil(around / (kSpacing * m.radius))));
  const int grips = std::max(8, int(std::ceil(around / (kGripSpacing * m.radius))));
  const auto out = [](double turn) { return Vec3d{portable::cos(turn), portable::sin(turn), 0}; };
  for (int i = 0; i < beads; ++i) m.beads.push_back(middle * out(2 * portable::pi * i / beads));
  for (int i = 0; i < grips; ++i) {
    const Vec3d to = out(2 * portable::pi * i / grips);
    for (const Vec3d side : {to, Vec3d{0, 0, 1}, -to, Vec3d{0, 0, -1}})
      m.grips.push_back(middle * to + m.radius * side);
  }
  m.closed = true;
  const double r2 = m.radius * m.radius, m2 = middle * middle;
  const double across = m.mass * (m2 / 2 + 0.625 * r2), along = m.mass * (m2 + 0.75 * r2);  // of a solid torus
  m.inertia = {{{across, 0, 0}, {0, across, 0}, {0, 0, along}}};
}

std::vector<Vec3d> spaced(const std::vector<Vec3d>& line, double spacing) {
  std::vector<Vec3d> out{line.front()};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const int parts = std::max(1, int(std::ceil(length(line[i] - line[i - 1]) / spacing)));
    for (int k = 1; k <= parts; ++k) out.push_back(line[i - 1] + (double(k) / parts) * (line[i] - line[i - 1]));
  }
  return out;
}

/// Equal beads; its frame's origin becomes their middle.
void make_line(const std::vector<Vec3d>& line, RigidModel& m) {
  m.beads = spaced(line, kSpacing * m.radius);
  Vec3d middle;
  for (const Vec3d& p : m.beads) middle += p / double(m.beads.size());
  for (Vec3d& p : m.beads) p -= middle;
  const double each = m.mass / double(m.beads.size());
  for (const Vec3d& p : m.beads) {
    const double own = 0.4 * each * m.radius * m.radius + each * dot(p, p);
    m.inertia = m.inertia + Mat3d{{{own, 0, 0}, {0, own, 0}, {0, 0, own}}} - each * outer(p, p);
    for (const Vec3d side : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
      m.grips.push_back(p + m.radius * side), m.grips.push_back(p - m.radius * side);
  }
}

/// Five balls as thick as it is: one in the middle, and one at either end of its length and of its width.
void make_pebble(Vec3d half, RigidModel& m) {
  m.pebble = half;
  const double along = half.x - m.radius, across = half.y - m.radius;
  m.beads = {{0, 0, 0}, {along, 0, 0}, {-along, 0, 0}, {0, across, 0}, {0, -across, 0}};
  for (const Vec3d& p : m.beads)
    for (const Vec3d side : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
      m.grips.push_back(p + m.radius * side), m.grips.push_back(p - m.radius * side);
  const Vec3d h2{half.x * half.x, half.y * half.y, half.z * half.z};  // of a solid ellipsoid
  m.inertia = {{{h2.y + h2.z, 0, 0}, {0, h2.x + h2.z, 0}, {0, 0, h2.x + h2.y}}};
  for (auto& row : m.inertia.m)
    for (double& entry : row) entry *= 0.2 * m.mass;
}

RigidModel compiled(const RigidSetting& s) {
  RigidModel m;
  m.name = s.name;
  m.look = s.look;
  m.mass = s.mass;
  m.radius = 0.5 * s.thick;
  m.friction = s.friction;
  m.place = s.place;
  m.turn = quat_from_two_vectors(Vec3d{0, 0, 1}, s.axis);
  if (s.outer > 0)
    make_ring(s.outer, m);
  else if (s.pebble.x > 0)
    make_pebble(0.5 * s.pebble, m);
  else
    make_line(s.chain, m);
  for (const Vec3d& p : m.beads) m.reach = std::max(m.reach, length(p) + m.radius);
  return m;
}

/// In the middle of a pouch's volume in the drawn shape.
void put_in(const RigidSetting& s, const sim::Model& model, RigidModel& m, std::vector<core::Fault>& faults) {
  const int pouch = model.membrane_index(s.pouch);
  if (pouch < 0 || !model.membranes[std::size_t(pouch)].sheet.closed()) {
    faults.push_back({s.at, "expected the name of a pouch that '" + s.name + "' lies in, got \"" + s.pouch + "\""});
    return;
  }
  m.inside = pouch;
  const tissue::MembraneModel& sheet = model.membranes[std::size_t(pouch)].sheet;
  m.place = tissue::enclosed_volume(sheet.triangles, sheet.network.rest, {}).centre;
}

}  // namespace

Key RigidScene::row() {
  Key row = keys::objects(kKey, rigid_shape, 0, "rigid objects, default none");
  row.max_count = 64;
  return row;
}

RigidSetting RigidScene::read(const JsonObject& o) {
  RigidSetting s;
  s.name = o.text("name");
  s.look = o.text("look", "plastic");
  s.outer = o.number("outer_mm") / 1000;
  for (const Vec3d& p : o.points("line_mm")) s.chain.push_back(p / 1000.0);
  s.pebble = o.vec3("pebble_mm") / 1000.0;
  s.thick = o.names("pebble_mm") ? s.pebble.z : o.number("thick_mm", 1) / 1000;
  s.mass = o.number("mass_g", 1) / 1000;
  s.friction = o.number("friction", s.friction);
  s.place = o.vec3("at_mm") / 1000.0;
  s.axis = o.vec3("axis", s.axis);
  s.pouch = o.text("in", "");
  s.at = o.at();
  s.text = o.value();
  const int shapes = int(o.names("outer_mm")) + int(o.names("line_mm")) + int(o.names("pebble_mm"));
  if (shapes != 1)
    o.fault(o.at(), "expected a ring with outer_mm, a line with line_mm or a pebble with pebble_mm, got " +
                        std::string(shapes == 0 ? "none of them" : "several"));
  if (o.names("pebble_mm") == o.names("thick_mm"))
    o.fault(o.at(), "expected thick_mm for a ring or a line, and for these alone, got " +
                        std::string(o.names("thick_mm") ? "it for a pebble" : "none"));
  if (o.names("pebble_mm") && !(s.pebble.x >= s.pebble.y && s.pebble.y >= s.pebble.z))
    o.fault("pebble_mm", "expected the widest diameter first and the smallest last, got another order");
  if (s.outer > 0 && s.outer < 2.5 * s.thick)
    o.fault("outer_mm", "expected a ring with a hole, at least 2.5 times as wide as it is thick, got a narrower one");
  if (o.names("in") && !o.names("pebble_mm")) o.fault("in", "expected a pebble in a pouch, got another shape");
  if (o.names("in") == o.names("at_mm"))
    o.fault(o.at(), "expected at_mm for a free object only, got " +
                        std::string(o.names("in") ? "it for an object in a pouch" : "none"));
  if (!(length(s.axis) > 1e-6)) o.fault("axis", "expected a direction, got none");
  return s;
}

void RigidScene::bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp) {
  for (RigidSetting& s : settings)
    if (s.pebble.x > 0) s.place = warp(s.place);
}

void RigidScene::compile(const std::vector<Setting>& settings, const Description&, sim::Model& model,
                         std::vector<core::Fault>& faults) {
  if (settings.empty()) return;
  interactions::RigidModels& out = interactions::part_of<interactions::Rigid>(model);
  double thickest = 0;
  for (const RigidSetting& s : settings) {
    out.list.push_back(compiled(s));
    if (!s.pouch.empty()) put_in(s, model, out.list.back(), faults);
    thickest = std::max(thickest, s.thick);
  }
  std::vector<const tissue::Skin*> walls;
  for (const sim::WallModel& w : model.walls) walls.push_back(&w.skin);
  out.walls = interactions::make_wall_grid(walls, 0.5 * thickest + kNearWalls);
}

}  // namespace trocar::scene
