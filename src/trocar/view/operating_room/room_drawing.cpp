#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/operating_room/room_drawing.hpp>
#include <trocar/view/operating_room/room_meshes.hpp>

namespace trocar::view {

using kinematics::BodyShape;
using kinematics::Frame;
using kinematics::ShapeKind;

namespace {

constexpr float kMattGloss = 0.25f, kSatinGloss = 1.2f, kPolished = 3.0f;  // glosses
constexpr double kSlender = 0.010;  // a part with less of a radius is steel, not a body [m]
// where the lamp hangs in the room [m]
const Vec3d kRoomLamp{-1.2, -0.9, 3.0};

render::Mat4 matrix(const Frame& f) {
  Mat3f r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = float(f.r.m[i][j]);
  return render::placement(r, vec_cast<float>(f.p));
}

/// What is on a body of an arm: covers of enamel, dark hubs at their ends, shafts of steel.
MeshBuffer link_mesh(const kinematics::Mechanism& m, int body) {
  MeshBuffer b;
  for (const BodyShape& s : m.shapes) {
    if (s.body != body) continue;
    if (s.kind == ShapeKind::box) {
      room::add_box(b, s.from, s.turn, 0.5 * s.to, 0.012, room::kGunmetal);
      room::add_box(b, s.from, s.turn, 0.5 * Vec3d{s.to.x + 0.003, s.to.y + 0.003, 0.3 * s.to.z}, 0.006, room::kAccent);
      continue;
    }
    if (s.radius < kSlender) {
      if (s.radius < 0.0045)
        room::add_rod(b, s.from, s.to, s.radius, s.radius, room::kSteel, 24);
      else
        room::add_rod(b, s.from, s.to, s.radius, s.radius, room::kEnamel);
      continue;
    }
    const double whole = length(s.to - s.from);
    room::add_rod(b, s.from, s.to, s.radius, s.radius, room::kEnamel, 36);
    if (whole > 4 * s.radius) {  // bands where covers meet
      const Vec3d along = (s.to - s.from) / whole;
      for (const double at : {0.9 * s.radius, whole - 0.9 * s.radius})
        room::add_cylinder(b, s.from + (at - 0.006) * along, s.from + (at + 0.006) * along, 1.04 * s.radius,
                           room::kGunmetal);
    }
  }
  // hinges: a hub about the axis
  const kinematics::Body& it = m.bodies[std::size_t(body)];
  if (it.motion == kinematics::Motion::turn) {
    double radius = 0, side = 0;
    for (const BodyShape& s : m.shapes)
      if (s.body == body && s.kind != ShapeKind::box && length(cross(s.from, it.axis)) < 2 * s.radius &&
          s.radius >= 0.008) {
        radius = std::max(radius, 1.3 * s.radius);
        side = dot(s.from, it.axis);
      }
    const bool about_itself = std::any_of(m.shapes.begin(), m.shapes.end(), [&](const BodyShape& s) {
      return s.body == body && length(cross(s.to - s.from, it.axis)) < 0.1 * length(s.to - s.from);
    });
    if (radius > 0 && !about_itself)
      room::add_cylinder(b, (side - 1.15 * radius) * it.axis, (side + 1.15 * radius) * it.axis, radius,
                         room::kGunmetal);
  }
  return b;
}

MeshBuffer stand_mesh(const Scenery::Arm& a, double floor) {
  MeshBuffer b;
  room::add_rod(b, a.foot, a.head, 0.040, 0.036, room::kEnamel, 40);
  room::add_cylinder(b, a.head - Vec3d{0, 0, 0.05}, a.head + Vec3d{0, 0, 0.055}, 0.052, room::kGunmetal);
  const Vec3d over{a.head.x, a.head.y, a.hub.z};
  room::add_rod(b, over, a.hub, 0.034, 0.030, room::kEnamel, 40);
  room::add_rod(b, a.hub, a.hub, 0.040, 0.040, room::kGunmetal, 40);
  if (a.on_table)
    room::add_box(b, a.foot, Mat3d::identity(), {0.06, 0.05, 0.05}, 0.012, room::kGunmetal);
  else {
    room::add_box(b, {a.foot.x, a.foot.y, floor + 0.07}, Mat3d::identity(), {0.24, 0.30, 0.06}, 0.05, room::kEnamel);
    room::add_cylinder(b, {a.foot.x, a.foot.y, floor + 0.12}, {a.foot.x, a.foot.y, floor + 0.5}, 0.085, room::kEnamel);
  }
  return b;
}

MeshBuffer cone_mesh(const Scenery::Cone& c) {
  MeshBuffer b;
  constexpr int kConeSides = 64, kConeRows = 8;
  const auto [u, v] = room::across(c.axis);
  const std::uint32_t apex = b.add(vec_cast<float>(c.apex), c.colour.paint());
  std::uint32_t before = 0;
  for (int row = 1; row <= kConeRows; ++row) {
    const double r = c.length * row / kConeRows;
    room::Colour faded = c.colour;
    faded.a = std::uint8_t(faded.a * (1 - 0.85 * row / kConeRows));
    const std::uint32_t first = b.size();
    for (int k = 0; k < kConeSides; ++k) {
      const double a = portable::two_pi * k / kConeSides;
      const Vec3d d = std::cos(c.half_angle) * c.axis + std::sin(c.half_angle) * (std::cos(a) * u + std::sin(a) * v);
      b.add(vec_cast<float>(c.apex + r * d), faded.paint());
    }
    if (row == 1)
      join_pole(b, first, kConeSides, apex, false);
    else
      join_rows(b, before, first, kConeSides, true);
    before = first;
  }
  return b;
}

}  // namespace

RoomDrawing::Piece RoomDrawing::piece(const MeshBuffer& b, float gloss) const {
  Piece p;
  p.mesh = OwnedMesh(*m_backend, b.data());
  p.material.shading = render::Shading::vertex_colour;
  p.material.wetness = gloss;
  p.material.two_sided = true;
  return p;
}

RoomDrawing::RoomDrawing(render::Backend& backend, const Scenery& s) : m_backend(&backend) {
  Piece floor = piece(room::floor_mesh(s), 0);
  floor.material.shading = render::Shading::unlit;
  m_still.push_back(std::move(floor));
  m_still.push_back(piece(room::table_column_mesh(s), kSatinGloss));
  for (const Scenery::Monitor& m : s.monitors) m_still.push_back(piece(room::monitor_mesh(m, s.floor), kSatinGloss));
  m_patient.push_back(piece(room::drape_mesh(s), kMattGloss));
  m_patient.push_back(piece(room::skin_mesh(s), kMattGloss));
  m_patient.push_back(piece(room::head_mesh(s), kMattGloss));
  m_patient.push_back(piece(room::table_mesh(s), kSatinGloss));
  for (const Scenery::Arm& a : s.arms) add_arm(a);
  move(s);
}

void RoomDrawing::add_arm(const Scenery::Arm& arm) {
  ArmPieces pieces;
  for (int body = 0; body < int(arm.mechanism->bodies.size()); ++body) {
    const MeshBuffer b = link_mesh(*arm.mechanism, body);
    if (b.size() > 0) pieces.links.emplace_back(body, piece(b, kSatinGloss));
  }
  m_arms.push_back(std::move(pieces));
}

void RoomDrawing::place_arms(const Scenery& s) {
  for (std::size_t k = 0; k < m_arms.size(); ++k) {
    const Scenery::Arm& a = s.arms[k];
    for (auto& [body, p] : m_arms[k].links)
      p.transform = matrix(s.table * (a.base * a.pose->frames[std::size_t(body)]));
    m_arms[k].stand.clear();
    Scenery::Arm stand = a;
    if (!a.on_table) stand.foot = s.table * a.foot, stand.head = s.table * a.head, stand.hub = s.table * a.hub;
    Piece p = piece(stand_mesh(stand, s.floor), kSatinGloss);
    if (a.on_table) p.transform = matrix(s.table);
    m_arms[k].stand.push_back(std::move(p));
  }
}

void RoomDrawing::move(const Scenery& s) {
  const render::Mat4 table = matrix(s.table);
  for (Piece& p : m_patient) p.transform = table;
  place_arms(s);
  m_people.clear();
  for (const Scenery::Person& p : s.people) m_people.push_back(piece(room::person_mesh(p, s.floor), kMattGloss));
  m_marks.clear();
  const auto on_table = [&](const MeshBuffer& b, float gloss) {
    Piece p = piece(b, gloss);
    p.transform = table;
    m_marks.push_back(std::move(p));
  };
  for (const Scenery::Port& p : s.ports) on_table(room::port_mesh(p), kPolished);
  for (const Scenery::Instrument& i : s.instruments) on_table(room::handle_mesh(i), kPolished);
  for (const Scenery::Gap& g : s.gaps) {
    MeshBuffer b;
    const room::Colour colour = g.bad ? room::Colour{226, 84, 40} : room::Colour{40, 120, 190};
    room::add_rod(b, g.from, g.to, 0.004, 0.004, colour, 12);
    for (const Vec3d p : {g.from, g.to}) room::add_rod(b, p, p, 0.009, 0.009, colour, 16);
    on_table(b, kMattGloss);
  }
  for (const Vec3d& c : s.chosen) {
    MeshBuffer b;
    const Vec3d n = s.figure.normal(c.x, c.y);
    const auto [u, v] = room::across(n);
    for (int k = 0; k < 48; ++k) {
      const double a = portable::two_pi * k / 48, e = portable::two_pi * (k + 1) / 48;
      const auto at = [&, u = u, v = v](double angle) {
        return c + 0.0025 * n + 0.009 * (std::cos(angle) * u + std::sin(angle) * v);
      };
      room::add_rod(b, at(a), at(e), 0.0016, 0.0016, {252, 252, 252}, 10);
    }
    on_table(b, kMattGloss);
  }
  for (const Scenery::Cone& c : s.cones) {
    on_table(cone_mesh(c), 0);
    m_marks.back().translucent = true;
    m_marks.back().material.shading = render::Shading::unlit;
  }
  m_patient[1] = piece(room::skin_mesh(s), kMattGloss);
  m_patient[1].transform = table;
}

render::Frame RoomDrawing::frame(const UprightOrbit& orbit) const {
  render::Frame f;
  f.camera = render::look_at(vec_cast<float>(orbit.eye()), vec_cast<float>(orbit.target), {0, 0, 1});
  f.camera.vertical_fov = 0.62f;
  f.camera.near_plane = float(std::max(0.02, 0.03 * orbit.distance));
  f.camera.far_plane = 14;
  const Vec3f to_lamp = vec_cast<float>(kRoomLamp) - f.camera.position;
  f.light.position = {dot(f.camera.rotation.column(0), to_lamp), dot(f.camera.rotation.column(1), to_lamp),
                      dot(f.camera.rotation.column(2), to_lamp)};
  f.light.colour = {1.0f, 0.985f, 0.96f};
  f.light.inverse_square = false;
  f.light.intensity = 0.52f;
  f.light.bounce = 0.16f;
  f.light.bounce_colour = {0.90f, 0.96f, 1.0f};
  f.light.ambient = 0.28f;
  f.look = render::plain_look();
  f.look.auto_exposure = false;
  f.look.contact = 0;
  f.look.sharpen = 0.35f;
  f.look.saturation = 0.85f;
  f.look.exposure_ev = -0.35f;
  f.quality.samples = 4;
  f.background = render::srgb(222, 227, 229);
  const auto add = [&](const Piece& p) {
    render::DrawItem item;
    item.mesh = p.mesh.handle();
    item.material = p.material;
    item.transform = p.transform;
    item.translucent = p.translucent;
    f.items.push_back(item);
  };
  for (const Piece& p : m_still) add(p);
  for (const Piece& p : m_patient) add(p);
  for (const Piece& p : m_people) add(p);
  for (const ArmPieces& a : m_arms) {
    for (const auto& [body, p] : a.links) add(p);
    for (const Piece& p : a.stand) add(p);
  }
  for (const Piece& p : m_marks) add(p);
  return f;
}

}  // namespace trocar::view
