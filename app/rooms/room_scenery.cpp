#include "rooms/room_scenery.hpp"

#include <cmath>

namespace trocar::app {

using studies::RoomModel;
using studies::RoomPose;

view::Scenery scenery_of(const RoomModel& model, const RoomPose& pose) {
  const scene::Room& room = model.room();
  view::Scenery s;
  s.figure = model.figure();
  s.table = model.table_frame(pose.tilt);
  s.top = model.top();
  s.floor = model.floor();
  s.table_width = room.table.width;
  s.table_thickness = room.table.thickness;
  for (std::size_t k = 0; k < room.staff.size(); ++k) {
    const RoomModel::Body b = model.person(int(k), pose);
    const scene::RoomPerson& p = room.staff[k];
    view::Scenery::Person out;
    out.facing = b.facing;
    for (int side = 0; side < 2; ++side)
      out.shoulder[side] = b.shoulder[side], out.elbow[side] = b.elbow[side], out.hand[side] = b.hand[side];
    out.foot = {p.x, p.y, model.floor() + p.step};
    out.stature = p.stature;
    out.step = p.step;
    out.scrubbed = p.role != scene::StaffRole::anaesthetist;
    s.people.push_back(out);
  }
  for (const scene::RoomMonitor& m : room.monitors) {
    const studies::PlacedShape screen = model.screen(m);
    s.monitors.push_back({screen.a, screen.b, screen.axes});
  }
  for (const scene::RoomPort& p : room.ports) {
    Vec3d out = model.figure().normal(p.position.x, p.position.y);
    for (std::size_t i = 0; i < room.instruments.size(); ++i)
      if (const Vec3d way = p.position - model.tip_of(pose, int(i));
          room.instruments[i].port == p.name && length(way) > 0)
        out = way / length(way);
    for (std::size_t a = 0; a < model.arms().size(); ++a)
      if (model.arms()[a].described->port == p.name) {
        const Vec3d axis = model.shaft(pose, int(a)).r.column(2);
        out = dot(axis, out) < 0 ? -axis : axis;
      }
    s.ports.push_back({p.position, out, p.diameter / 2});
  }
  for (std::size_t i = 0; i < room.instruments.size(); ++i)
    s.instruments.push_back({model.tip_of(pose, int(i)), model.handle(pose, int(i)), room.instruments[i].radius,
                             room.instruments[i].camera});
  for (std::size_t a = 0; a < model.arms().size(); ++a) {
    const studies::ArmModel& arm = model.arms()[a];
    view::Scenery::Arm out;
    out.mechanism = &arm.mechanism;
    out.pose = &pose.frames[a];
    out.base = model.base(int(a), pose.tilt);
    out.on_table = arm.described->on_table;
    std::vector<studies::RoomPart> stand;
    for (studies::RoomPart& p : model.arm_parts(pose, int(a)))
      if (p.stand) stand.push_back(std::move(p));
    out.foot = stand[0].shape.a;
    out.head = stand[0].shape.b;
    out.hub = stand[1].shape.b;
    s.arms.push_back(out);
  }
  return s;
}

void show_clearance(view::Scenery& s, const RoomModel& model, const RoomPose& pose, double within) {
  for (const studies::Near& n : model.nearest(pose)) {
    if (n.distance > within) break;
    s.gaps.push_back({n.from, n.to, n.distance < model.room().margin});
  }
}

void show_reach(view::Scenery& s, const RoomModel& model) {
  constexpr double kHalf = 1.0472;
  constexpr view::painted::Colour kColours[] = {
      {86, 180, 233, 90}, {230, 159, 0, 90}, {0, 158, 115, 90}, {204, 121, 167, 90}};
  for (std::size_t k = 0; k < model.room().ports.size(); ++k) {
    const scene::RoomPort& p = model.room().ports[k];
    s.cones.push_back({p.position, model.figure().normal(p.position.x, p.position.y), kHalf, 0.22, kColours[k % 4]});
  }
}

}  // namespace trocar::app
