#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/interactions/instrument/wall_stop.hpp>

namespace trocar::interactions {
namespace {

constexpr double kGive = 0.0002;      // [m] that a spring gives before the tissue slips
constexpr float kNewestShare = 0.1f;  // of the newest normal force in its average: about ten ticks
// [N] that a contact spring can exert at most: 1500 N/m over the 4 mm that it may move tissue in a tick. Where tissue
// cannot give way, friction's spring pushes along the normal, too: without this bound it would feed on itself.
constexpr float kMostSpringPress = 6;
constexpr float kMostAtWall = 1e6f;  // [N] no bound

bool before_in_book(const Touch& a, const Touch& b) noexcept {
  if (a.body != b.body) return a.body < b.body;
  return a.element != b.element ? a.element < b.element : a.part < b.part;
}

/// A part's frame: shafts are measured from the hinge, jaws from their roots.
struct PartFrame {
  Vec3d origin, x, y, z;
};
/// Turned with the shaft as far as the link's own direction lets it.
PartFrame frame_of_link(const ToolShape& shape, const Capsule& rod) noexcept {
  constexpr double kAlong = 0.2;  // sine of the angle to a direction that is no guide any more
  const Vec3d z = normalised(rod.b - rod.a, shape.shaft.axis());
  const Vec3d across = shape.shaft.normal() - dot(shape.shaft.normal(), z) * z;
  const Vec3d other = shape.shaft.opening() - dot(shape.shaft.opening(), z) * z;
  const Vec3d x = normalised(length(across) > kAlong ? across : other);
  return {rod.a, x, cross(z, x), z};
}
PartFrame frame_of(const ToolShape& shape, int part) noexcept {
  if (part >= kFirstLink) return frame_of_link(shape, shape.rod(part));
  const Capsule& rod = shape.part[part < kToolParts ? part : kJawA];
  if (part == kShaft) return {rod.b, shape.shaft.normal(), shape.shaft.opening(), shape.shaft.axis()};
  const Vec3d x = shape.frame.normal();
  const Vec3d z = normalised(rod.b - rod.a, shape.frame.axis());
  return {rod.a, x, cross(z, x), z};
}

Vec3d into(const PartFrame& f, Vec3d p) noexcept {
  const Vec3d d = p - f.origin;
  return {dot(d, f.x), dot(d, f.y), dot(d, f.z)};
}
Vec3d out_of(const PartFrame& f, const float (&p)[3]) noexcept {
  return f.origin + double(p[0]) * f.x + double(p[1]) * f.y + double(p[2]) * f.z;
}

void put(float (&to)[3], Vec3d from) noexcept {
  to[0] = float(from.x);
  to[1] = float(from.y);
  to[2] = float(from.z);
}

}  // namespace

const Touch* TouchBook::find(BodyId body, std::int32_t element, std::int32_t part) const noexcept {
  Touch key;
  key.body = body;
  key.element = element;
  key.part = part;
  const Touch* at = std::lower_bound(touch, touch + count, key, before_in_book);
  return at != touch + count && at->body == body && at->element == element && at->part == part ? at : nullptr;
}

bool TouchBook::near(BodyId body, std::int32_t element) const noexcept {
  Touch key;
  key.body = body;
  key.element = element;
  key.part = kShaft;
  const Touch* at = std::lower_bound(touch, touch + count, key, before_in_book);
  return at != touch + count && at->body == body && at->element == element;
}

void start_here(const ToolState& tool, const kinematics::Joints& joints, TouchBook& book, Vec3d shift) noexcept {
  book.yaw = tool.yaw;
  book.pitch = tool.pitch;
  book.roll = tool.roll;
  book.depth = tool.depth;
  book.aperture = tool.aperture;
  book.joints = joints;
  book.shift = shift;
  book.count = book.reserved = 0;
}

ToolShape shape_before(const ToolModel& model, const TouchBook& book) noexcept {
  return shape_of(model, {book.yaw, book.pitch, book.roll, book.depth}, book.joints, book.aperture, book.shift);
}

Touching::Touching(double friction, const ToolShape& was_at, const ToolShape& is_at, int number, const TouchBook& was,
                   TouchBook& will_be) noexcept
    : shape(is_at), before(was_at), tool(number), last(was), next(will_be), m_friction(friction) {
  next.count = 0;
  for (int part = kShaft; part < end_of(shape); part = interactions::next(part))
    m_way[part] = collision::way_of(before.rod(part), shape.rod(part));
}

std::int32_t Touching::note(BodyId body, std::int32_t element, std::int32_t part, std::int32_t vertex) noexcept {
  if (next.count == kMaxTouches) return 0;
  Touch& t = next.touch[next.count++];
  t = {};
  t.body = body;
  t.element = element;
  t.part = part;
  t.vertex = vertex;
  return next.count;
}

const Touch* Touching::anchored(BodyId body, std::int32_t element, std::int32_t part) const noexcept {
  const Touch* was = last.find(body, element, part);
  return was && was->anchored ? was : nullptr;
}

Rub Touching::rub(std::int32_t number, const Contact& c, Vec3d anchored_now) noexcept {
  Rub r;
  if (number == 0) return r;
  Touch& t = next.touch[number - 1];
  put(t.normal, c.normal);
  t.anchored = 1;
  const PartFrame frame = frame_of(shape, t.part);
  for (int k = 0; k < 2; ++k) r.weight[k] = c.weight[k];
  const Touch* was = anchored(t.body, t.element, t.part);
  if (was) t.force = (1 - kNewestShare) * was->force;
  if (!was || was->vertex != t.vertex) {
    put(t.anchor, into(frame, c.point));
    for (int k = 0; k < 2; ++k) t.weight[k] = float(c.weight[k]);
    return r;
  }
  Vec3d off = out_of(frame, was->anchor) - anchored_now;
  off -= dot(off, c.normal) * c.normal;
  const double far = length(off), bound = m_friction * double(was->force);
  r.stiffness = bound / kGive;
  if (far <= kGive) {
    if (far > 1e-9 && bound > 0) r.kind = Rub::sticks;
    r.to = off;
    for (int k = 0; k < 2; ++k) t.weight[k] = was->weight[k];
    for (int k = 0; k < 2; ++k) r.weight[k] = double(was->weight[k]);
    for (int k = 0; k < 3; ++k) t.anchor[k] = was->anchor[k];
    return r;
  }
  // It slips: the anchor is dragged along behind the point that is nearest now.
  constexpr double kSlow = 0.01;  // [m/s]
  r.to = (kGive / far) * off;
  for (int k = 0; k < 2; ++k) t.weight[k] = float(c.weight[k]);
  put(t.anchor, into(frame, c.point + r.to));
  if (!(bound > 0)) return r;
  float here[3];
  put(here, into(frame, c.point));
  const Vec3d surface = (c.point - out_of(frame_of(before, t.part), here)) / core::kTick;
  Vec3d slip = surface - c.velocity;
  slip -= dot(slip, c.normal) * c.normal;
  const double speed = length(slip);
  r.kind = speed > kSlow ? Rub::slips : Rub::sticks;  // hardly moving, the spring with the bound's pull does it
  if (r.kind == Rub::sticks) return r;
  r.dir = slip / speed;
  r.damping = bound / speed;
  r.speed = dot(surface, r.dir);
  return r;
}

void press_on(TouchBook& next, std::int32_t number, Vec3d force) noexcept {
  if (number <= 0 || number > next.count) return;
  Touch& t = next.touch[number - 1];
  t.force += kNewestShare *
             float(force.x * double(t.normal[0]) + force.y * double(t.normal[1]) + force.z * double(t.normal[2]));
}

void remember(const ToolState& tool, const kinematics::Joints& joints, TouchBook& next, TouchBook& book,
              Vec3d shift) noexcept {
  std::sort(next.touch, next.touch + next.count, before_in_book);
  for (Touch* t = next.touch; t != next.touch + next.count; ++t)
    t->force = std::clamp(t->force, 0.0f, t->body.is(BodyKind::wall) ? kMostAtWall : kMostSpringPress);
  std::copy(next.touch, next.touch + next.count, book.touch);
  start_here(tool, joints, book, shift);
  book.count = next.count;
}

void add_to_hash(core::Hasher& hasher, const TouchBook& book) noexcept { core::add_fields(hasher, book); }

void note_wall(const WallStop& stop, Touching& touching) noexcept {
  if (!stop.stopped) return;
  const std::int32_t number = touching.note(BodyId::wall(), 0, stop.part);
  if (number == 0) return;
  Touch& t = touching.next.touch[number - 1];
  t.anchored = 1;
  t.force = float(stop.force);
  put(t.normal, -stop.normal);
  put(t.anchor, into(frame_of(touching.shape, stop.part), stop.at));
}

Vec3d place_of(const ToolShape& shape, const Touch& touch) noexcept {
  return out_of(frame_of(shape, touch.part), touch.anchor);
}

Vec3d press_of(const Touch& touch) noexcept {
  return double(touch.force) * Vec3d{touch.normal[0], touch.normal[1], touch.normal[2]};
}

namespace {

/// Where an instrument is touched, all in all; its tip where nothing is known.
Vec3d touched_at(const ToolShape& shape, const TouchBook& book) noexcept {
  Vec3d sum{0, 0, 0};
  double force = 0;
  for (const Touch* t = book.touch; t != book.touch + book.count; ++t) {
    if (!t->anchored || !(t->force > 0)) continue;
    sum += double(t->force) * place_of(shape, *t);
    force += double(t->force);
  }
  return force > 0 ? sum / force : shape.frame.tip;
}

}  // namespace

TrocarLoad load_at_trocar(const ToolModel& model, const ToolState& tool, const TouchBook& book) noexcept {
  const ToolShape shape = shape_of(model, tool.pose(), book.joints, tool.aperture, book.shift);
  const Vec3d port = model.port + book.shift;
  TrocarLoad r{};
  const auto add = [&r, port](Vec3d at, Vec3d force) {
    r.force += force;
    r.moment += cross(at - port, force);
  };
  const double* contact = tool.contact_force;
  add(touched_at(shape, book), {contact[0], contact[1], contact[2]});
  for (int i = 0; i < tool.holds; ++i) {
    const Hold& h = tool.hold[i];
    add(from_jaw(shape, {h.local[0], h.local[1], h.local[2]}), -Vec3d{h.force[0], h.force[1], h.force[2]});
  }
  const Vec3d axis = shape.shaft.axis();
  const double outside = outside_of(model, tool.depth), along = dot(r.force, axis);
  const Vec3d lever = cross(r.moment, axis) / outside;  // axis x lever = moment across the axis / outside
  r.by_hand = lever - along * axis;
  r.on_wall = r.force - along * axis + lever;
  r.turning = dot(r.moment, axis);
  return r;
}

}  // namespace trocar::interactions
