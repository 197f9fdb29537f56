#include <algorithm>
#include <cmath>

#include <trocar/interactions/instrument/linkage_works.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {

using namespace metal;

namespace {

std::vector<InstrumentPart> rigid_parts(const ToolModel& tool) {
  for (const KindShape& shape : kKindShapes)
    if (shape.kind == tool.kind) return shape.parts(tool);
  return {};
}

/// A rod with round ends about 0 and `length`.
MeshBuffer knuckle(double from, double to, double radius) {
  constexpr int kSteps = 6;
  std::vector<TurnPoint> outline;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = 0.5 * portable::pi * (1 - double(i) / kSteps);
    outline.push_back({from - radius * std::sin(a), i == 0 ? 0 : radius * std::cos(a), kClean});
  }
  for (int i = 0; i <= kSteps; ++i) {
    const double a = 0.5 * portable::pi * i / kSteps;
    outline.push_back({to + radius * std::sin(a), i == kSteps ? 0 : radius * std::cos(a), kClean});
  }
  return turned(outline, kAround);
}

/// Shaft and links; what is before the last hinge's end looks as it does on the rigid instrument.
std::vector<InstrumentPart> bending_parts(const ToolModel& tool) {
  constexpr double kHead = 0.0105, kNarrow = 0.92;  // [m] that the jaws' fork takes; of the shaft's radius
  ToolModel head = tool;
  head.shaft_length = kHead;
  std::vector<InstrumentPart> parts = rigid_parts(head);
  const double r = kNarrow * tool.shaft_radius;
  parts.push_back({PartJoint::shaft, "insulated", shaft(tool, 0)});
  const kinematics::Chain straight = kinematics::chain(tool.bends, {0, 0, 0}, {0, 0, 0, 0.1}, {}, tool.jaw_length);
  for (int i = 0; i < straight.links; ++i) {
    const double way = length(straight.bend[i + 1] - straight.bend[i]);
    parts.push_back(
        {PartJoint::link, "steel", knuckle(0, i + 1 < straight.links ? way : std::max(0.0, way - kHead), r), i});
  }
  return parts;
}

}  // namespace

std::vector<InstrumentPart> instrument_parts(const ToolModel& tool) {
  return tool.bends.bends() ? bending_parts(tool) : rigid_parts(tool);
}

std::vector<InstrumentPart> sleeve_parts(double radius, double reach, double from) {
  constexpr double slant = 0.7;
  const double r = radius + kSleeveWall, back = std::min(-0.05, from - 0.02), end = reach - slant * r;
  MeshBuffer b = turned({{back, 0, kShaded},
                         {back, r, kClean},
                         {back, r, kClean},
                         {end - 0.03, r, kClean},
                         {end - 0.0004, r, kClean},
                         {end, r - 0.0003, kClean},
                         {end, r - 0.0003, kClean},
                         {end, radius, kClean},
                         {end, radius, kShaded},
                         {end - 0.012, radius, kHollow},
                         {end - 0.012, 0, kHollow}},
                        kAround);
  for (Vec3f& p : b.positions)
    if (p.z > float(end - 0.02)) p.z += float(slant) * p.x;
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "sleeve", std::move(b)});
  return parts;
}

std::vector<InstrumentPart> scope_parts(double radius) {
  std::vector<InstrumentPart> parts;
  const double r = radius;
  parts.push_back({PartJoint::body, "steel",
                   turned({{-0.31, 0, kClean},
                           {-0.31, r, kClean},
                           {-0.31, r, kClean},
                           {-0.0006, r, kClean},
                           {0, 0.92 * r, kClean},
                           {0, 0.92 * r, kClean},
                           {0, 0.5 * r, kClean},
                           {0, 0.5 * r, kHollow},
                           {-0.001, 0.48 * r, kHollow},
                           {-0.001, 0, kHollow}},
                          kAround)});
  return parts;
}

namespace {

Placement placed(Vec3d x, Vec3d z, Vec3d origin) {
  return {Mat3f::from_columns(vec_cast<float>(x), vec_cast<float>(cross(z, x)), vec_cast<float>(z)),
          vec_cast<float>(origin)};
}

/// A link is round: how it is turned about itself does not show.
Placement placed_link(const interactions::Capsule& link, Vec3d opening) {
  const Vec3d z = normalised(link.b - link.a);
  const Vec3d off = opening - dot(opening, z) * z;
  return placed(length(off) > 0.1 ? normalised(off) : any_perpendicular(z), z, link.a);
}

}  // namespace

Placement placement_of(PartJoint joint, const interactions::ToolShape& shape, int link) {
  if (joint == PartJoint::shaft) return placed(shape.shaft.opening(), shape.shaft.axis(), shape.shaft.tip);
  if (joint == PartJoint::link) return placed_link(shape.link[link], shape.frame.opening());
  const Vec3d axis = shape.frame.axis(), open = shape.frame.opening();
  if (joint == PartJoint::needle) return placed(open, axis, shape.frame.tip - shape.needle_in * axis);
  const double side = joint == PartJoint::jaw_b ? -1 : 1;
  Vec3d x = side * open, z = axis, origin = shape.pivot;
  if (joint != PartJoint::body) {
    const double c = 1 / std::sqrt(1 + shape.tangent * shape.tangent), s = c * shape.tangent;
    z = c * axis + (side * s) * open;
    x = side * (c * open) - s * axis;
    origin += (side * shape.half_gap) * open;
  }
  const Vec3d y = cross(z, x);
  return {Mat3f::from_columns(vec_cast<float>(x), vec_cast<float>(y), vec_cast<float>(z)), vec_cast<float>(origin)};
}

Placement placement_of_works(const ToolModel& tool, const interactions::ToolShape& shape, int part, double aperture) {
  const Placement body = placement_of(PartJoint::body, shape);
  const kinematics::Frame at =
      interactions::at_handle(tool.works->parts[std::size_t(part)], interactions::handle_of(tool.linkage, aperture));
  const Mat3f r = Mat3f::from_columns(vec_cast<float>(at.r.column(0)), vec_cast<float>(at.r.column(1)),
                                      vec_cast<float>(at.r.column(2)));
  return {body.rotation * r, body.translation + body.rotation * vec_cast<float>(at.p)};
}

double aperture_in_sleeve(const ToolModel& tool, double beyond, double radius) {
  // The space for a jaw's back, at the sleeve's end or at the jaw's.
  const double along = std::min(beyond, tool.jaw_length), space = radius - 1.25 * tool.jaw_thickness;
  if (along <= 0) return 1;
  const double half_angle = std::atan2(std::max(0.0, space), along), half_gap = std::max(0.0, space);
  double aperture = 1;
  if (tool.opening > 0) aperture = std::min(aperture, 2 * half_angle / tool.opening);
  if (tool.parallel_gap > 0) aperture = std::min(aperture, 2 * half_gap / tool.parallel_gap);
  return aperture;
}

double clip_seat(const ToolModel& tool) { return tool.jaw_length - tool.clip_length; }

}  // namespace trocar::view
